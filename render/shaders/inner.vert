// A rectangle inside a planar DP's region: every pixel of it is the DP's.
uniform usamplerBuffer inner;  // x lo, y lo, x hi, y hi | slot
uniform float shrink;          // pixels
flat out uint id;

void main() {
  int rectangle = gl_VertexID >> 2, i = gl_VertexID & 3;
  vec4 ends = uintBitsToFloat(texelFetch(inner, 2 * rectangle));
  int slot = int(texelFetch(inner, 2 * rectangle + 1).x);
  vec4 rx = slot_texel(slot, 8), ry = slot_texel(slot, 9), rf = slot_texel(slot, 10);
  vec2 inwards = vec2(i == 1 || i == 2 ? -1.0 : 1.0, i >= 2 ? -1.0 : 1.0);
  vec2 c = vec2(i == 1 || i == 2 ? ends.z : ends.x, i >= 2 ? ends.w : ends.y), ju, jv;
  jacobian(c, rx, ry, rf, ju, jv);
  vec2 way = shrink * vec2(way_per_pixel(ju, jv, vec2(0.0, 1.0)), way_per_pixel(ju, jv, vec2(1.0, 0.0)));
  c += inwards * min(way, 0.5 * (ends.zw - ends.xy));
  vec3 at = vec3(c, 1.0);
  id = uint(slot) + 1u;
  gl_Position = to_clip(vec2(dot(rx.xyw, at), dot(ry.xyw, at)), dot(rf.xyw, at));
}
