uniform vec2 pixel;        // 2 / picture
uniform vec3 depth_terms;  // window depth = x + y·depth + z/depth
uniform float near_depth;
flat in vec3 s, f, p, q;
flat in vec4 bend, depth;
flat in vec3 side0, side1, side2, side3;
flat in uvec3 id;
flat in vec2 z0;
layout(location = 0) out uint out_id;

bool region_contains(inout Region at) {
  vec3 here = vec3(at.p.xy, 1.0);
  if (!(at.p.z >= depth.y - at.rounding && at.p.z <= depth.z + at.rounding)) return false;
  if (!(min(min(dot(side0, here), dot(side1, here)), min(dot(side2, here), dot(side3, here))) >= 0.0)) return false;
  at.near = false;
  test_pieces(at, int(id.z), id.y);
  return at.inside;
}

#ifdef EDGES
// The features among the footprint's sides and the prism's ends.
void meet_bounds(inout Region at) {
  uint features = id.y >> 8;
  vec3 here = vec3(at.p.xy, 1.0), up = vec3(0.0, 0.0, 1.0);
  if ((features & 1u) != 0u) meet_edge(at, dot(side0, here), vec3(side0.xy, 0.0));
  if ((features & 2u) != 0u) meet_edge(at, dot(side1, here), vec3(side1.xy, 0.0));
  if ((features & 4u) != 0u) meet_edge(at, dot(side2, here), vec3(side2.xy, 0.0));
  if ((features & 8u) != 0u) meet_edge(at, dot(side3, here), vec3(side3.xy, 0.0));
  if ((features & 16u) != 0u) meet_edge(at, at.p.z - depth.y, up);
  if ((features & 32u) != 0u) meet_edge(at, at.p.z - depth.z, up);
}
#endif

// The point at t on the ray, and how it moves on the surface when the pixel's place moves by one pixel.
Region region_at(vec3 o, vec3 d, float t, float reach_here) {
  Region at;
  at.p = o + t * d;
  at.rounding = depth.w;
#ifdef EDGES
  vec3 g = quadric_gradient(bend, depth.x, at.p);
  vec3 across = reach_here * pixel.x * p, down = reach_here * pixel.y * q;
  float along = dot(g, d);
  at.px = across - d * (dot(g, across) / along);
  at.py = down - d * (dot(g, down) / along);
  at.nearest = 1e30;
#endif
  return at;
}

void main() {
  vec2 at = gl_FragCoord.xy * pixel - 1.0;
  vec3 across = at.x * p + at.y * q;
  vec3 o = s + z0.y * across, d = f + spread * across;
  Roots roots = quadric_roots(bend, depth.x, o, d);
  if (!(roots.discriminant >= 0.0)) discard;
#ifdef FRONT_ONLY
  // Only one of the two is met from outside: there F falls along the ray, or rises if n points inwards.
  bool on_second = (id.y & kFlipped) != 0u ? roots.slope < 0.0 : roots.slope >= 0.0;
  float t = on_second ? roots.q / roots.A : roots.C / roots.q, z = z0.x + t;
  Region region = region_at(o, d, t, z0.y + spread * t);
  bool hit = z >= near_depth && region_contains(region);
#else
  float first = roots.C / roots.q, second = roots.q / roots.A, t = 0.0, z = 0.0;
  bool second_nearer = second < first, hit = false, on_second = second_nearer;
  Region region;
  for (int i = 0; i < 2; ++i) {
    on_second = second_nearer != (i == 1);
    t = on_second ? second : first;
    z = z0.x + t;
    region = region_at(o, d, t, z0.y + spread * t);
    hit = z >= near_depth && region_contains(region);
    if (hit) break;
  }
#endif
  if (!hit) discard;
  out_id = on_second ? id.x | kSecondRoot : id.x;
#ifdef EDGES
  meet_bounds(region);
  out_id |= edge_bits(sqrt(region.nearest));
#endif
  gl_FragDepth = depth_terms.x + depth_terms.y * z + depth_terms.z / z;
}
