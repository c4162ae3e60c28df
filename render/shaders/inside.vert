// A rectangle inside a planar DP's region: every pixel of it is the DP's. It gives way, by rounding, to what has been drawn along the
// boundary, whose pixels know how much of them an edge covers.
uniform usamplerBuffer rectangles;  // x lo, y lo, x hi, y hi | slot
uniform int first;
flat out uint id;
#ifdef AT_ONCE
flat out vec3 normal, own;
#endif

void main() {
  int at = first + 2 * (gl_VertexID >> 2), slot = int(texelFetch(rectangles, at + 1).x);
  vec4 ends = uintBitsToFloat(texelFetch(rectangles, at));
  id = uint(slot) + 1u;
  gl_Position = rectangle_corner(ends, gl_VertexID & 3, 0.02, slot_texel(slot, 8), slot_texel(slot, 9), slot_texel(slot, 10));
  gl_Position.z *= kBehind;
#ifdef AT_ONCE
  planar_look(slot, normal, own);
#endif
}
