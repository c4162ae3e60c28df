// Transform feedback: one vertex a visible DP, from its record, its placement and the camera to its slot.
layout(location = 0) in uvec4 item;  // record, instance, primitive, color

flat out uvec4 slot0, slot1, slot2, slot3, slot4, slot5, slot6, slot7, slot8, slot9, slot10, slot11;

int instance() { return int(item.y) * kInstanceTexels; }
vec3 instance_texel(int i) { return texelFetch(instances, instance() + i).xyz; }

// The rotation of a unit quaternion of which the three smallest parts are stored.
mat3 frame(vec3 parts, uint largest) {
  float m = sqrt(max(0.0, 1.0 - dot(parts, parts)));
  vec4 q = largest == 0u ? vec4(m, parts) : largest == 1u ? vec4(parts.x, m, parts.yz)
         : largest == 2u ? vec4(parts.xy, m, parts.z) : vec4(parts, m);
  float x = q.x, y = q.y, z = q.z, w = q.w;
  return mat3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y),
              2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
              2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
}

uvec4 words(vec3 v, uint w) { return uvec4(floatBitsToUint(v), w); }

void main() {
  int at = int(item.x);
  uvec4 first = texelFetch(heap, at), second = texelFetch(heap, at + 1);
  uint meta = first.w;
  vec3 origin = uintBitsToFloat(first.xyz);
  mat3 m = frame(uintBitsToFloat(second.xyz), (meta >> 6) & 3u);

  // S = hi + lo: hi − origin is exact where it matters, with the camera near the DP.
  vec4 hi = texelFetch(instances, instance()), lo = texelFetch(instances, instance() + 1);
  vec3 r = (hi.xyz - origin) + lo.xyz;
  vec3 s = r * m;  // mᵀ r
  vec4 c01 = heap_texel(at + 2), c23;
  at += 3;
  if ((meta & kRectangle) != 0u) {
    c23 = c01.zwxw;
    c01 = c01.xyzy;
  } else {
    c23 = heap_texel(at++);
  }
  vec4 bend = vec4(0.0), depth = vec4(0.0);
  if ((meta & kPlanar) == 0u) {
    bend = heap_texel(at);
    depth = heap_texel(at + 1);
    at += 2;
  }
  uint cubic = 0u;  // where the normal's cubic terms are
  if ((meta & kCubic) != 0u) cubic = uint(at++);
  // How far rounding may have moved a point: neighbours are widened by it, so that no ray passes between them.
  vec4 far = max(abs(c01), abs(c23));
  float extent = max(max(far.x, far.y), max(far.z, far.w));
  float rounding = 3e-7 * (max(max(abs(origin.x), abs(origin.y)), abs(origin.z)) + length(s) + extent);
  vec3 row_x = instance_texel(5), row_y = instance_texel(6), row_f = instance_texel(7);

  float z0 = start_depth - dot(row_f, r);
  vec3 f = instance_texel(2) * m;
  s += (z0 - start_depth) * f;

  slot0 = words(s, meta);
  slot1 = words(f, (meta & kPieces) != 0u ? uint(at) : 0u);
  slot2 = words(instance_texel(3) * m, item.w);
  slot3 = words(instance_texel(4) * m, floatBitsToUint(rounding));
  slot4 = floatBitsToUint(bend);
  slot5 = uvec4(floatBitsToUint(depth.xyz), floatBitsToUint(hi.w) + second.w + 1u);
  slot6 = floatBitsToUint(c01);
  slot7 = floatBitsToUint(c23);
  slot8 = words(row_x * m, floatBitsToUint(-dot(row_x, r)));
  slot9 = words(row_y * m, floatBitsToUint(-dot(row_y, r)));
  slot10 = words(row_f * m, floatBitsToUint(z0));
  slot11 = uvec4(item.z, floatBitsToUint(lo.w), cubic, floatBitsToUint(z0));
}
