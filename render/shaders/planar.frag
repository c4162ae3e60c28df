uniform vec2 pixel;  // 2 / picture
flat in vec3 side0, side1, side2, side3;
flat in uint id;
#ifdef PIECES
flat in vec3 row_x, row_y, row_w;
flat in ivec2 pieces;
flat in float rounding;
#endif
#ifdef EDGES
flat in vec4 no_edge;
#endif
layout(location = 0) out uint out_id;
#ifdef AT_ONCE
flat in vec3 normal, own;
layout(location = 1) out vec4 out_color;
#endif

void main() {
  vec3 at = vec3(gl_FragCoord.xy * pixel - 1.0, 1.0);
  vec4 sides = vec4(dot(side0, at), dot(side1, at), dot(side2, at), dot(side3, at));
  if (min(min(sides.x, sides.y), min(sides.z, sides.w)) < 0.0) discard;
  out_id = id;
#ifdef EDGES
  vec4 far = sides + no_edge;  // in pixels
  float nearest = min(min(far.x, far.y), min(far.z, far.w));
#endif
#ifdef PIECES
  float w = 1.0 / dot(row_w, at);
  vec2 p = vec2(dot(row_x, at), dot(row_y, at)) * w;
  Region region;
  region.p = vec3(p, 0.0);
  region.rounding = rounding;
  region.near = false;
#ifdef EDGES
  region.px = vec3((vec2(row_x.x, row_y.x) - p * row_w.x) * (w * pixel.x), 0.0);
  region.py = vec3((vec2(row_x.y, row_y.y) - p * row_w.y) * (w * pixel.y), 0.0);
  region.nearest = 1e30;
#endif
  test_pieces(region, pieces.x, uint(pieces.y));
  if (!region.inside) discard;
#ifdef EDGES
  nearest = min(nearest, sqrt(region.nearest));
#endif
#endif
  float edge = 0.0;
#ifdef EDGES
  edge = edge_cover(nearest);
  out_id |= edge_bits(edge);
#endif
#ifdef AT_ONCE
  out_color = color_at_once(normal, own, at.xy, edge);
#endif
}
