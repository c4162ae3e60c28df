// What is seen of domains: the nearest one's surface gives the place, and all that blend with it there give their normals and colors, weighted
// with Ψ. That is the "ideal" that Reniers & Telea describe in §4, a ray for each pixel: domains are looked up at the place itself, so that none
// is seen from the side, and what sums to less than 1 is no darker.
uniform usamplerBuffer domain_neighbors;
uniform usampler2D face_picture;
uniform usamplerBuffer colors;

const float kLeastWeight = 0.002;
// How far another domain's surface may be from the place, in its texels, to be the same surface.
const float kSameSheet = 2.0;

struct Blend {
  vec3 normal, color;
  float weight, most;
  uint face;
};

void add_domain(Domain d, vec3 from_center, bool always, inout Blend sum) {
  vec3 p = in_domain(d, from_center);
  if (!always && any(greaterThan(abs(p.xy), vec2(1.0)))) return;
  vec4 color_psi = color_psi_at(d, p.xy);
  if (color_psi.w < kLeastWeight) return;
  vec4 t = normal_height_at(d, p.xy);
#ifdef HEIGHTS
  float texel = max(2.0 * d.half_u / d.tile.z, 2.0 * d.half_v / d.tile.w);
  if (!always && abs(p.z - mix(d.lo, d.hi, t.w)) > kSameSheet * texel + slack(d)) return;
#endif
  vec3 n = local_normal(d, t);
  // Where orientations are not known, those of two domains may be opposite.
  if (dot(n, sum.normal) < 0.0) n = -n;
  sum.normal += color_psi.w * n;
  sum.color += color_psi.w * color_psi.xyz;
  sum.weight += color_psi.w;
  if (color_psi.w > sum.most) {
    sum.most = color_psi.w;
#ifdef TEXTURE_FACES
    sum.face = texelFetch(face_picture, ivec2(texel_place(d, p.xy)), 0).x;
#else
    sum.face = d.face;
#endif
  }
}

// The highest byte of a color says more of its face than its color.
uint to_word(vec3 c, uint face_color) {
  uvec3 b = uvec3(clamp(c, 0.0, 1.0) * 255.0 + 0.5);
  return b.x | b.y << 8 | b.z << 16 | face_color & 0xff000000u;
}

Surface surface_at(uint number, vec2 at) {
  uvec4 run = run_of(own_number(number));
  int index = int(run.z + own_number(number) - run.x);
  Placed placed = placed_at(int(run.y), at);
  Domain d = domain_at(index);
  vec3 from_s = (d.center - placed.hi) - placed.lo, from_center = placed.origin - from_s;
  float t = max(0.0, domain_hit(d, in_domain(d, from_center), in_domain(d, placed.direction)));
  vec3 hit = placed.origin + t * placed.direction;  // relative to S
  Blend sum = Blend(vec3(0.0), vec3(0.0), 0.0, 0.0, d.face);
  add_domain(d, hit - from_s, true, sum);
#ifndef OPAQUE
  for (int i = 0; i < d.neighbors; ++i) {
    Domain other = domain_at(int(texelFetch(domain_neighbors, d.first_neighbor + i).x));
    add_domain(other, hit - ((other.center - placed.hi) - placed.lo), false, sum);
  }
#endif
  Surface result;
  result.normal = normalize(placed.to_view * (dot(sum.normal, sum.normal) > 0.0 ? sum.normal : d.n));
  result.depth = start_depth + t;
  result.face = placed.first_face + sum.face + 1u;
  result.primitive = run.w + uint(index) - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
#ifdef TEXTURE_COLORS
  if (result.color >> 24 != 0xfeu) result.color = to_word(sum.color / max(sum.weight, 1e-6), result.color);
#endif
  result.edge = 0.0;
  result.direction = vec3(0.0);
  result.curvature = vec2(0.0);
  return result;
}
