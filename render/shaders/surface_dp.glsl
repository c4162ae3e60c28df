// A DP's surface point under a pixel: the ray meets the quadric again, and everything follows from F there.

bool is_mine(uint number) { return (number & kTriangle) == 0u; }

Surface surface_at(uint number, vec2 at) {
  int slot = int(number & kSlotMask) - 1;
  uvec4 t0 = texelFetch(slots, slot * kSlotTexels), t1 = texelFetch(slots, slot * kSlotTexels + 1),
        t2 = texelFetch(slots, slot * kSlotTexels + 2), t5 = texelFetch(slots, slot * kSlotTexels + 5);
  vec4 t3 = slot_texel(slot, 3), bend = slot_texel(slot, 4);
  vec3 s = uintBitsToFloat(t0.xyz), f = uintBitsToFloat(t1.xyz), p = uintBitsToFloat(t2.xyz), q = t3.xyz;
  float c = uintBitsToFloat(t5.x);
  uint meta = t0.w;

  uvec4 t11 = texelFetch(slots, slot * kSlotTexels + 11);
  float z0 = uintBitsToFloat(t11.w);
  vec3 across = at.x * p + at.y * q, o = s + reach(z0) * across, d = f + spread * across;
  Roots roots = quadric_roots(bend, c, o, d);
  bool on_second = (meta & kPlanar) == 0u && ((number & kFallingRoot) != 0u) == (roots.slope >= 0.0);
  float t = on_second ? roots.q / roots.A : roots.C / roots.q;
  vec3 x = o + t * d, g = quadric_gradient(bend, c, x);

  vec3 right = p * axis_scale.x, up = q * axis_scale.y;
  vec3 back = spread * (axis_offset.x * right + axis_offset.y * up) - f;
  vec3 normal_form = g;
  uint cubic = t11.z;
  if (cubic != 0u) {
    vec2 tilt = unpacked_tilt(texelFetch(heap, int(cubic) - 1).w);
    normal_form.xy -= cubic_gradient(heap_texel(int(cubic)), tilt, x.xy);
  }
  vec3 gradient = vec3(dot(normal_form, right), dot(normal_form, up), dot(normal_form, back));
  float size = length(gradient), outside = (meta & kFlipped) != 0u ? -1.0 : 1.0;

  Surface result;
  vec3 n = gradient / size;
  result.normal = outside * n;
  result.depth = z0 + t;
  result.face = t5.w;
  result.color = t2.w;
  result.primitive = t11.x;
  result.curvature = vec2(0.0);
  result.direction = vec3(0.0);
#ifdef CURVES
  principal_curvatures(n, size, mat3(right, up, back), bend, c, result.curvature, result.direction);
  result.curvature *= outside;
#endif
  result.edge = float((number >> kEdgeShift) & 63u) / kEdgeLevels;
  return result;
}
