flat in vec3 s, f, p, q, buffer_depth;
flat in vec2 centre;
flat in vec4 bend, depth;
flat in vec3 side0, side1, side2, side3;
flat in uvec3 id;
flat in vec3 z0;
#ifdef CONIC
flat in vec3 form_a, form_b;
flat in vec4 form_c;
flat in float form_near;
#endif
#ifdef EDGES
flat in vec2 dp_ends;
#ifndef PIECES
flat in uvec4 edges;
#endif
#endif
layout(location = 0) out uint out_id;
#ifdef AT_ONCE
flat in vec3 own;
flat in vec4 cubic, sight;
flat in vec2 axes;
flat in uint tilt;
layout(location = 1) out vec4 out_color;
#endif

#ifdef SECTIONS
uniform vec2 pixel;  // 2 / picture
uniform vec4 sections[SECTIONS];  // see proxy.glsl
#endif

// Within the tile, not too near the eye and not cut away.
bool in_tile(vec3 at, float z) {
#ifdef SECTIONS
  vec4 place = vec4((gl_FragCoord.xy * pixel - 1.0) * reach(z), z, 1.0);
  for (int i = 0; i < SECTIONS; ++i)
    if (dot(sections[i], place) < 0.0) return false;
#endif
  vec3 here = vec3(at.xy, 1.0);
  float inside = min(min(dot(side0, here), dot(side1, here)), min(dot(side2, here), dot(side3, here)));
#ifdef CONIC
  float c = dot(form_c.xyz, here);
  inside = min(inside, form_c.w * (dot(form_a, here) * dot(form_b, here) - c * c) + form_near);
#endif
  // A neighbour begins where its own rounding says, and a ray may graze both.
  float ends = min(at.z - depth.y, depth.z - at.z) + 3.0 * depth.w;
  return min(min(inside, ends), z - buffer_depth.z) >= 0.0;
}

#ifdef EDGES
// The features among the DP's bounds; the footprint's sides are the tile's if it is the whole.
void meet_bounds(inout Region at) {
  uint features = id.y >> 8;
  vec3 here = vec3(at.p.xy, 1.0), up = vec3(0.0, 0.0, 1.0);
#ifdef PIECES
  if ((features & 1u) != 0u) meet_edge(at, dot(side0, here), vec3(side0.xy, 0.0));
  if ((features & 2u) != 0u) meet_edge(at, dot(side1, here), vec3(side1.xy, 0.0));
  if ((features & 4u) != 0u) meet_edge(at, dot(side2, here), vec3(side2.xy, 0.0));
  if ((features & 8u) != 0u) meet_edge(at, dot(side3, here), vec3(side3.xy, 0.0));
#endif
  if ((features & 16u) != 0u) meet_edge(at, at.p.z - dp_ends.x, up);
  if ((features & 32u) != 0u) meet_edge(at, at.p.z - dp_ends.y, up);
}
#endif

// A point of the surface at that reach of the ray d, and how it moves there when the pixel's place moves by one pixel.
Region region_at(vec3 at, vec3 d, float reach_here) {
  Region r;
  r.p = at;
  r.rounding = depth.w;
  r.near = false;
#ifdef EDGES
  vec3 g = quadric_gradient(bend, depth.x, at);
  vec3 across = reach_here * p, down = reach_here * q;
  float along = dot(g, d);
  r.px = across - d * (dot(g, across) / along);
  r.py = down - d * (dot(g, down) / along);
  r.nearest = 1e30;
#endif
#if defined(PIECES)
  test_pieces(r, int(id.z), id.y);
#else
  r.inside = true;
#ifdef PLANES
  test_planes(r, int(id.z) + 1, int((id.y >> 16) & 255u), int(id.y >> 24));
#endif
#endif
  return r;
}

void main() {
  vec2 from = gl_FragCoord.xy - centre;
  vec3 across = from.x * p + from.y * q;
  vec3 o = s + z0.y * across, d = f + z0.z * across;
  Roots roots = quadric_roots(bend, depth.x, o, d);
  if (!(roots.discriminant >= 0.0)) discard;
#ifdef ONE_ROOT
  // Only one of the two is met from the side that is seen: from where n points to F falls along the ray, and rises from the other.
  bool on_second = ((id.y & (kFlipped | kFromBehind)) == kFlipped || (id.y & (kFlipped | kFromBehind)) == kFromBehind)
                       ? roots.slope < 0.0 : roots.slope >= 0.0;
  float t = on_second ? roots.q / roots.A : roots.C / roots.q;
  vec3 x = o + t * d;
  if (!in_tile(x, z0.x + t)) discard;
  Region region = region_at(x, d, z0.y + z0.z * t);
#else
  float first = roots.C / roots.q, second = roots.q / roots.A;
  bool on_second = second < first;
  float t = on_second ? second : first, other = on_second ? first : second;
  vec3 x = o + t * d, y = o + other * d;
  bool hit = in_tile(x, z0.x + t), other_hit = in_tile(y, z0.x + other);
  if (!(hit || other_hit)) discard;
  if (!hit) {
    t = other;
    x = y;
    on_second = !on_second;
  }
  Region region = region_at(x, d, z0.y + z0.z * t);
#if defined(PIECES) || defined(PLANES)
  // Seldom: the nearer one is in the tile, but not in the region. A loop, since there are drivers that work through both sides of
  // every branch.
  for (bool again = hit && other_hit && !region.inside; again; again = false) {
    t = other;
    x = y;
    on_second = !on_second;
    region = region_at(x, d, z0.y + z0.z * t);
  }
#endif
#endif
  if (!region.inside) discard;
  out_id = on_second == (roots.slope >= 0.0) ? id.x | kFallingRoot : id.x;
  float edge = 0.0;
#ifdef EDGES
  meet_bounds(region);
#ifndef PIECES
  meet_edges(region, edges);
#endif
  edge = edge_cover(sqrt(region.nearest));
  out_id |= edge_bits(edge);
#endif
#ifdef AT_ONCE
  vec3 gradient = quadric_gradient(bend, depth.x, x);
  gradient.xy -= cubic_gradient(cubic, unpacked_tilt(tilt), x.xy);
  vec2 in_picture = vec2(dot(gradient, p), dot(gradient, q)) * axes;
  vec3 normal = normalize(vec3(in_picture, -dot(in_picture, sight.xy) - dot(gradient, f)));
  out_color = color_at_once(normal, own, sight, from, edge);
#endif
  float z = z0.x + t;
  gl_FragDepth = (buffer_depth.x + buffer_depth.y * z) / (z0.z > 0.0 ? z : 1.0);
}
