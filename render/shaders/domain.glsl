// Domain primitives: their records, and where a ray meets the surface that a domain's texture describes.
uniform samplerBuffer domains;   // domain_records.h
uniform sampler2D psi_picture, normal_picture;
uniform vec2 atlas_texel;        // 1 / its size

const int kDomainTexels = 5;
const int kMostSteps = 24;
const float kTexelsAStep = 1.5;
// Less of a domain than this does not decide what is seen: its surface may be some other domain's that just fades out here.
#ifdef OPAQUE
const float kLeastSeen = 0.05;
#else
const float kLeastSeen = 0.15;
#endif

struct Domain {
  vec3 center, u, v, n;
  float half_u, half_v, lo, hi;
  uint face;
  int first_neighbor, neighbors;
  vec4 tile;  // of the atlas, in texels
};

Domain domain_at(int index) {
  int at = index * kDomainTexels;
  vec4 t0 = texelFetch(domains, at), t1 = texelFetch(domains, at + 1), t2 = texelFetch(domains, at + 2), t3 = texelFetch(domains, at + 3);
  Domain d;
  d.center = t0.xyz;
  d.u = t1.xyz;
  d.v = t2.xyz;
  d.n = cross(d.u, d.v);
  d.half_u = t0.w;
  d.half_v = t1.w;
  d.lo = t2.w;
  d.hi = t3.x;
#ifndef HEIGHTS
  d.lo = d.hi = 0.0;
#endif
  d.face = floatBitsToUint(t3.y);
  d.first_neighbor = int(floatBitsToUint(t3.z));
  d.neighbors = int(floatBitsToUint(t3.w));
  d.tile = texelFetch(domains, at + 4);
  return d;
}

// From -1 … 1 over the rectangle to the atlas, in texels; between the centers of the tile's own.
vec2 texel_place(Domain d, vec2 xy) { return d.tile.xy + clamp((0.5 + 0.5 * xy) * d.tile.zw, vec2(0.5), d.tile.zw - 0.5); }
vec4 normal_height_at(Domain d, vec2 xy) { return textureLod(normal_picture, texel_place(d, xy) * atlas_texel, 0.0); }
vec3 local_normal(Domain d, vec4 t) {
#ifdef NORMAL_MAPS
  vec3 n = (t.xyz * 255.0 - 128.0) / 127.0;
  return n.x * d.u + n.y * d.v + n.z * d.n;
#else
  return d.n;
#endif
}
float height_at(Domain d, vec2 xy) {
#ifdef HEIGHTS
  return mix(d.lo, d.hi, normal_height_at(d, xy).w);
#else
  return 0.0;
#endif
}
vec4 color_psi_at(Domain d, vec2 xy) {
  vec4 t = textureLod(psi_picture, texel_place(d, xy) * atlas_texel, 0.0);
#ifdef TEXTURE_COLORS
  return t;
#else
  return vec4(1.0, 1.0, 1.0, t.x);
#endif
}

// How far above and below its heights a domain's box reaches: not nothing, and half a step of heights, so that rounding misses none.
float slack(Domain d) { return (d.hi - d.lo) / 255.0 + 1e-4 * min(d.half_u, d.half_v); }

// A part's point relative to the domain: over the rectangle from -1 to 1, and its height.
vec3 in_domain(Domain d, vec3 p) { return vec3(dot(p, d.u) / d.half_u, dot(p, d.v) / d.half_v, dot(p, d.n)); }

// The nearest t at which o + t d, in the domain's coordinates, meets its surface where it is seen; negative: nowhere. A few steps, about as many
// as texels are passed, look for a change of sides; two secants then find the place.
float domain_hit(Domain domain, vec3 o, vec3 d) {
  vec3 lo = vec3(-1.0, -1.0, domain.lo - slack(domain)), hi = vec3(1.0, 1.0, domain.hi + slack(domain));
  vec3 way = mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
  vec3 a = (lo - o) / way, b = (hi - o) / way, first = min(a, b), last = max(a, b);
  float t0 = max(max(first.x, first.y), max(first.z, 0.0)), t1 = min(min(last.x, last.y), last.z);
  if (t0 >= t1) return -1.0;
  vec2 texels = abs(d.xy) * (t1 - t0) * 0.5 * domain.tile.zw;
#ifdef HEIGHTS
  int steps = clamp(int(ceil(max(texels.x, texels.y) / kTexelsAStep)), 1, kMostSteps);
#else
  int steps = 1;
#endif
  float dt = (t1 - t0) / float(steps), ta = t0;
  vec3 p = o + ta * d;
  float fa = p.z - height_at(domain, p.xy);
  for (int i = 1; i <= steps; ++i) {
    float tb = i == steps ? t1 : t0 + dt * float(i);
    p = o + tb * d;
    float fb = p.z - height_at(domain, p.xy);
    if (fa * fb <= 0.0) {
      float ts = fa == fb ? ta : ta + (tb - ta) * fa / (fa - fb);
#ifdef HEIGHTS
      p = o + ts * d;
      float fs = p.z - height_at(domain, p.xy);
      bool nearer = fa * fs <= 0.0;
      float tc = nearer ? ta : tb, fc = nearer ? fa : fb;
      if (fc != fs) ts += (tc - ts) * fs / (fs - fc);
#endif
      if (color_psi_at(domain, (o + ts * d).xy).w >= kLeastSeen) return ts;
    }
    ta = tb;
    fa = fb;
  }
  return -1.0;
}
