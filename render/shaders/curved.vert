// A curved DP: the prism footprint × [z lo, z hi], of which the far sides are drawn, so that every pixel is tried once, from inside too.
uniform int first_slot;
flat out vec3 s, f, p, q;
flat out vec4 bend, depth;  // λu λv a b | c, z lo, z hi, rounding
flat out vec3 side0, side1, side2, side3;
flat out uvec3 id;          // number, meta, pieces' texel

vec3 side_function(vec2 a, vec2 b, float rounding) {
  vec2 d = b - a;
  float l = length(d);
  if (l == 0.0) return vec3(0.0, 0.0, 1.0);
  vec2 inward = vec2(-d.y, d.x) / l;
  return vec3(inward, rounding - dot(inward, a));
}

void main() {
  int slot = first_slot + (gl_VertexID >> 3), i = gl_VertexID & 3;
  uvec4 t0 = texelFetch(slots, slot * kSlotTexels), t1 = texelFetch(slots, slot * kSlotTexels + 1);
  vec4 t3 = slot_texel(slot, 3), t5 = slot_texel(slot, 5), t11 = slot_texel(slot, 11);
  vec4 c01 = slot_texel(slot, 6), c23 = slot_texel(slot, 7);
  s = uintBitsToFloat(t0.xyz);
  f = uintBitsToFloat(t1.xyz);
  p = slot_texel(slot, 2).xyz;
  q = t3.xyz;
  bend = slot_texel(slot, 4);
  depth = vec4(t5.xyz, t3.w);
  id = uvec3(uint(slot) + 1u, t0.w, t1.w);
  side0 = side_function(c01.xy, c01.zw, t3.w);
  side1 = side_function(c01.zw, c23.xy, t3.w);
  side2 = side_function(c23.xy, c23.zw, t3.w);
  side3 = side_function(c23.zw, c01.xy, t3.w);

  vec4 rx = slot_texel(slot, 8), ry = slot_texel(slot, 9), rf = slot_texel(slot, 10);
  bool top = (gl_VertexID & 4) != 0;
  // A mirrored placement turns the prism inside out; so does exchanging its ends.
  if (dot(cross(rx.xyz, ry.xyz), rf.xyz) < 0.0) top = !top;
  vec4 at = vec4(corner_of(c01, c23, i), top ? t5.z : t5.y, 1.0);
  float w = spread > 0.0 ? abs(dot(rf, at)) : 1.0;
  float grow = 2.0 * kGrow * w * t11.y / (picture.y * 0.5 * max(length(ry.xyz), 1e-30));
  at.xy += miter(side_to(c01, c23, i), side_from(c01, c23, i), vec2(grow));
  at.z += top ? grow : -grow;
  gl_Position = to_clip(vec2(dot(rx, at), dot(ry, at)), dot(rf, at));
}
