flat in vec2 centre;
flat in vec3 side0, side1, side2, side3;
flat in uint id;
#ifdef CONIC
flat in vec3 form_a, form_b;
flat in vec4 form_c, form_w;
#endif
#if defined(PIECES) || defined(EDGES)
flat in vec3 row_x, row_y, row_w;
#endif
#ifdef PIECES
flat in ivec2 pieces;
flat in float rounding;
#endif
#ifdef EDGES
#ifdef PIECES
flat in vec4 no_edge;
#else
flat in uvec4 edges;
#endif
#endif
layout(location = 0) out uint out_id;
#ifdef AT_ONCE
flat in vec3 normal, own;
flat in vec4 sight;
layout(location = 1) out vec4 out_color;
#endif

void main() {
  vec3 at = vec3(gl_FragCoord.xy - centre, 1.0);
  vec4 sides = vec4(dot(side0, at), dot(side1, at), dot(side2, at), dot(side3, at));
  float inside = min(min(sides.x, sides.y), min(sides.z, sides.w));
#ifdef CONIC
  float c = dot(form_c.xyz, at), w1 = dot(form_w.xyz, at);
  inside = min(inside, form_c.w * (dot(form_a, at) * dot(form_b, at) - c * c) + form_w.w * w1 * w1);
#endif
  if (inside < 0.0) discard;
  float edge = 0.0;
#if defined(PIECES) || defined(EDGES)
  float w = 1.0 / dot(row_w, at);
  vec2 p = vec2(dot(row_x, at), dot(row_y, at)) * w;
  Region region;
  region.p = vec3(p, 0.0);
#ifdef EDGES
  region.px = vec3((vec2(row_x.x, row_y.x) - p * row_w.x) * w, 0.0);
  region.py = vec3((vec2(row_x.y, row_y.y) - p * row_w.y) * w, 0.0);
  region.nearest = 1e30;
#endif
#ifdef PIECES
  region.rounding = rounding;
  region.near = false;
  test_pieces(region, pieces.x, uint(pieces.y));
  if (!region.inside) discard;
#endif
#ifdef EDGES
#ifdef PIECES
  vec4 far = sides + no_edge;  // in pixels
  float nearest = min(min(min(far.x, far.y), min(far.z, far.w)), sqrt(region.nearest));
#else
  meet_edges(region, edges);
  float nearest = sqrt(region.nearest);
#endif
  edge = edge_cover(nearest);
#endif
#endif
#ifdef EDGES
  out_id = id | edge_bits(edge);
#else
  out_id = id;
#endif
#ifdef AT_ONCE
  out_color = color_at_once(normal, own, sight, at.xy, edge);
#endif
}
