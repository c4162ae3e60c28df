// A tile of a curved DP: a quadrilateral of the picture around the prism corners × [z lo, z hi]; or, where that reaches behind the eye, the prism
// itself, of which the far sides are drawn. Either way every pixel is tried once.
// Uniforms cost some drivers (llvmpipe) as much as twenty multiplications each in every fragment: what fragments need goes with the proxy.
flat out vec3 s, f, p, q;   // the ray of the pixel at `centre`, and how it moves from pixel to pixel, p to the right and q down
flat out vec2 centre;
uniform float near_depth;
flat out vec3 buffer_depth; // what is in the depth buffer is (x + y z) / z or, in parallel, x + y z; the nearest depth
flat out vec4 bend, depth;  // λu λv a b | c, z lo, z hi, rounding
flat out vec3 side0, side1, side2, side3;
flat out uvec3 id;          // number, meta, pieces' texel
flat out vec3 z0;           // the depth where rays start, their reach there, and spread
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
flat out vec4 cubic, sight;
flat out vec2 axes;         // the view's, in steps of p and q
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
#endif

void main() {
#ifdef PRISM
  Tile tile = tile_at(gl_VertexID >> 3);
#else
  Tile tile = tile_at(gl_VertexID >> 2);
#endif
  int slot = tile.slot, next = tile.next;
#ifndef PRISM
  vec4 p01 = uintBitsToFloat(texelFetch(tiles, next)), p23 = uintBitsToFloat(texelFetch(tiles, next + 1));
  uvec4 middle = texelFetch(tiles, next + 2);
  next += 3;
#endif
  uvec4 t0 = texelFetch(slots, slot * kSlotTexels), t1 = texelFetch(slots, slot * kSlotTexels + 1);
  vec4 t3 = slot_texel(slot, 3), t5 = slot_texel(slot, 5), t11 = slot_texel(slot, 11);
  vec4 c01 = tile.c01, c23 = tile.c23;
#ifdef PRISM
  centre = 0.5 * picture;
#else
  centre = vec2(middle.w & 0xffffu, middle.w >> 16) + 0.5;
#endif
  vec2 per_pixel = 2.0 / picture, at = centre * per_pixel - 1.0;
  p = slot_texel(slot, 2).xyz;
  q = t3.xyz;
  vec3 across = at.x * p + at.y * q;
  p *= per_pixel.x;
  q *= per_pixel.y;
  z0 = vec3(t11.w, reach(t11.w), spread);
#ifdef PRISM
  s = uintBitsToFloat(t0.xyz) + z0.y * across;
#else
  s = uintBitsToFloat(middle.xyz);
#endif
  f = uintBitsToFloat(t1.xyz) + spread * across;
  buffer_depth = vec3(spread > 0.0 ? depth_terms.zx : depth_terms.xy, near_depth);
  bend = slot_texel(slot, 4);
  depth = vec4(t5.x, tile.ends, t3.w);
  id = uvec3(uint(slot) + 1u, t0.w | (tile.from_behind ? kFromBehind : 0u), t1.w);
#ifdef AT_ONCE
  sight = sight_from(centre);
  axes = axis_scale / per_pixel;
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

#ifdef PRISM
  gl_Position = prism_corner(c01, c23, tile.ends, slot_texel(slot, 8), slot_texel(slot, 9), slot_texel(slot, 10), t11.y);
#else
  gl_Position = vec4(corner_of(p01, p23, gl_VertexID & 3), 0.5, 1.0);
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
