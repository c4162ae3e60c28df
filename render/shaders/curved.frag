uniform vec2 pixel;        // 2 / picture
uniform vec3 depth_terms;  // window depth = x + y·depth + z/depth
uniform float near_depth;
flat in vec3 s, f, p, q;
flat in vec4 bend, depth;
flat in vec3 side0, side1, side2, side3;
flat in uvec3 id;
layout(location = 0) out uint out_id;

bool region_contains(vec3 x) {
  vec3 at = vec3(x.xy, 1.0);
  float rounding = depth.w;
  if (!(x.z >= depth.y - rounding && x.z <= depth.z + rounding)) return false;
  if (!(min(min(dot(side0, at), dot(side1, at)), min(dot(side2, at), dot(side3, at))) >= 0.0)) return false;
#if defined(FLAT_ARCS)
  return flat_arcs_contain(id.y, x.xy, rounding);
#elif defined(PIECES)
  return bounded(int(id.z), id.y, x, rounding);
#else
  return true;
#endif
}

void main() {
  vec2 at = gl_FragCoord.xy * pixel - 1.0;
  vec3 across = at.x * p + at.y * q;
  vec3 o = s + start * across, d = f + spread * across;
  float t0 = -dot(o, d) / dot(d, d);
  o += t0 * d;
  float first, second, slope;
  if (!quadric_roots(bend, depth.x, o, d, first, second, slope)) discard;
#ifdef FRONT_ONLY
  // Only one of the two is met from outside: there F falls along the ray, or rises if n points inwards.
  bool on_second = (id.y & kFlipped) != 0u ? slope < 0.0 : slope >= 0.0;
  float t = on_second ? second : first, z = start_depth + t0 + t;
  bool hit = z >= near_depth && region_contains(o + t * d);
#else
  bool second_nearer = second < first;
  float t = 0.0, z = 0.0;
  bool hit = false, on_second = second_nearer;
  for (int i = 0; i < 2; ++i) {
    on_second = second_nearer != (i == 1);
    t = on_second ? second : first;
    z = start_depth + t0 + t;
    hit = z >= near_depth && region_contains(o + t * d);
    if (hit) break;
  }
#endif
  if (!hit) discard;
  out_id = on_second ? id.x | kSecondRoot : id.x;
  gl_FragDepth = depth_terms.x + depth_terms.y * z + depth_terms.z / z;
}
