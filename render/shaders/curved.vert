// A tile of a curved DP: a rectangle of the picture around the prism corners × [z lo, z hi]; or, where that reaches behind the eye, the prism
// itself, of which the far sides are drawn. Either way every pixel is tried once.
flat out vec3 s, f, p, q;
flat out vec4 bend, depth;  // λu λv a b | c, z lo, z hi, rounding
flat out vec3 side0, side1, side2, side3;
flat out uvec3 id;          // number, meta, pieces' texel
flat out vec2 z0;           // the depth where rays start, and their reach there
#ifdef CONIC
flat out vec3 form_a, form_b;
flat out vec4 form_c;       // and the sign inside
flat out float form_near;   // what is added for rounding
#endif
#ifdef EDGES
flat out float ink;
flat out vec2 dp_ends;      // the DP's own z lo, z hi
#ifndef PIECES
flat out uvec4 edges;
#endif
#endif
#ifdef AT_ONCE
flat out vec3 own;
flat out vec4 cubic;
flat out uint tilt;
#endif

vec3 side_function(vec2 a, vec2 b, float rounding) {
  vec2 d = b - a;
  float l = length(d);
  if (l == 0.0) return vec3(0.0, 0.0, 1.0);
  vec2 inward = vec2(-d.y, d.x) / l;
  return vec3(inward, rounding - dot(inward, a));
}

#ifdef PRISM
vec4 prism_corner(vec4 c01, vec4 c23, vec2 ends, vec4 rx, vec4 ry, vec4 rf, float scale_ratio) {
  int i = gl_VertexID & 3;
  bool top = (gl_VertexID & 4) != 0;
  // A mirrored placement turns the prism inside out; so does exchanging its ends.
  if (dot(cross(rx.xyz, ry.xyz), rf.xyz) < 0.0) top = !top;
  vec4 at = vec4(corner_of(c01, c23, i), top ? ends.y : ends.x, 1.0);
  float w = spread > 0.0 ? abs(dot(rf, at)) : 1.0;
  float grow = 2.0 * kGrow * w * scale_ratio / (picture.y * 0.5 * max(length(ry.xyz), 1e-30));
  at.xy += miter(side_to(c01, c23, i), side_from(c01, c23, i), vec2(grow));
  at.z += top ? grow : -grow;
  return to_clip(vec2(dot(rx, at), dot(ry, at)), dot(rf, at));
}
#else
struct Rectangle {
  vec2 axis, low, high;
};

vec2 on_picture(vec2 c, float z, vec4 rx, vec4 ry, vec4 rf) {
  vec4 at = vec4(c, z, 1.0);
  return vec2(dot(rx, at), dot(ry, at)) / (spread > 0.0 ? dot(rf, at) : 1.0) * picture * 0.5;
}

Rectangle around(vec2 axis, vec2 a, vec2 b, vec2 c, vec2 d, vec2 e, vec2 f, vec2 g, vec2 h) {
  axis = dot(axis, axis) > 1e-12 ? normalize(axis) : vec2(1.0, 0.0);
  mat2 turn = mat2(axis.x, -axis.y, axis.y, axis.x);
  a = turn * a, b = turn * b, c = turn * c, d = turn * d, e = turn * e, f = turn * f, g = turn * g, h = turn * h;
  return Rectangle(axis, min(min(min(a, b), min(c, d)), min(min(e, f), min(g, h))),
                   max(max(max(a, b), max(c, d)), max(max(e, f), max(g, h))));
}

float area(Rectangle r) {
  vec2 size = r.high - r.low + 1.0;
  return size.x * size.y;
}

// The smaller of the two rectangles around the prism's picture that are aligned with one of the footprint's first two sides.
vec2 picture_corner(vec4 c01, vec4 c23, vec2 ends, vec4 rx, vec4 ry, vec4 rf) {
  vec2 a = on_picture(c01.xy, ends.x, rx, ry, rf), b = on_picture(c01.zw, ends.x, rx, ry, rf);
  vec2 c = on_picture(c23.xy, ends.x, rx, ry, rf), d = on_picture(c23.zw, ends.x, rx, ry, rf);
  vec2 e = on_picture(c01.xy, ends.y, rx, ry, rf), f = on_picture(c01.zw, ends.y, rx, ry, rf);
  vec2 g = on_picture(c23.xy, ends.y, rx, ry, rf), h = on_picture(c23.zw, ends.y, rx, ry, rf);
  Rectangle first = around(b - a + f - e, a, b, c, d, e, f, g, h), second = around(c - b + g - f, a, b, c, d, e, f, g, h);
  if (area(second) < area(first)) first = second;
  int i = gl_VertexID & 3;
  vec2 p = vec2(i == 1 || i == 2 ? first.high.x + kGrow : first.low.x - kGrow, i >= 2 ? first.high.y + kGrow : first.low.y - kGrow);
  return (p.x * first.axis + p.y * vec2(-first.axis.y, first.axis.x)) * 2.0 / picture;
}
#endif

void main() {
#ifdef PRISM
  Tile tile = tile_at(gl_VertexID >> 3);
#else
  Tile tile = tile_at(gl_VertexID >> 2);
#endif
  int slot = tile.slot, next = tile.next;
  uvec4 t0 = texelFetch(slots, slot * kSlotTexels), t1 = texelFetch(slots, slot * kSlotTexels + 1);
  vec4 t3 = slot_texel(slot, 3), t5 = slot_texel(slot, 5), t11 = slot_texel(slot, 11);
  vec4 c01 = tile.c01, c23 = tile.c23;
  s = uintBitsToFloat(t0.xyz);
  f = uintBitsToFloat(t1.xyz);
  p = slot_texel(slot, 2).xyz;
  q = t3.xyz;
  bend = slot_texel(slot, 4);
  depth = vec4(t5.x, tile.ends, t3.w);
  z0 = vec2(t11.w, reach(t11.w));
  id = uvec3(uint(slot) + 1u, t0.w | (tile.from_behind ? kFromBehind : 0u), t1.w);
#ifdef AT_ONCE
  own = own_color(floatBitsToUint(slot_texel(slot, 2).w), floatBitsToUint(t5.w), floatBitsToUint(t11.x));
  int terms = int(floatBitsToUint(t11.z));
  cubic = terms > 0 ? heap_texel(terms) : vec4(0.0);
  tilt = terms > 0 ? texelFetch(heap, terms - 1).w : 0u;
#endif
#ifdef FLAT_ARCS
  fetch_pieces(int(t1.w), t0.w);
#endif
#ifdef CONIC
  Conic conic = conic_at(next);
  form_a = conic.a;
  form_b = conic.b;
  form_c = vec4(conic.c, conic.side);
  form_near = t3.w * conic.steepest;
#endif
  side0 = side_function(c01.xy, c01.zw, t3.w);
  side1 = side_function(c01.zw, c23.xy, t3.w);
  side2 = side_function(c23.xy, c23.zw, t3.w);
  side3 = side_function(c23.zw, c01.xy, t3.w);

  vec4 rx = slot_texel(slot, 8), ry = slot_texel(slot, 9), rf = slot_texel(slot, 10);
#ifdef PRISM
  gl_Position = prism_corner(c01, c23, tile.ends, rx, ry, rf, t11.y);
#else
  gl_Position = vec4(picture_corner(c01, c23, tile.ends, rx, ry, rf), 0.5, 1.0);
#endif
  cut_nothing();  // curved.frag does, point by point
#ifdef EDGES
  ink = ink_for(tile.dp_px);
  dp_ends = t5.yz;
#ifndef PIECES
  edges = texelFetch(tiles, next);
#endif
#endif
}
