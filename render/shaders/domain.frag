uniform vec2 pixel;
uniform vec3 depth_terms;
flat in uint number;
flat in int domain, instance;
layout(location = 0) out uint out_id;

#ifdef SECTIONS
uniform vec4 sections[SECTIONS];  // see proxy.glsl
#endif

void main() {
  vec2 at = gl_FragCoord.xy * pixel - 1.0;
  vec3 origin, direction;
  ray_of(instance, at, origin, direction);
  Domain d = domain_at(domain);
  vec3 from_center = origin - from_start(instance, d.center);
  float t = domain_hit(d, in_domain(d, from_center), in_domain(d, direction));
  if (t < 0.0) discard;
  float depth = start_depth + t;
#ifdef SECTIONS
  vec4 place = vec4(at * (spread > 0.0 ? depth : 1.0), depth, 1.0);
  for (int i = 0; i < SECTIONS; ++i)
    if (dot(sections[i], place) < 0.0) discard;
#endif
  gl_FragDepth = depth_terms.x + depth_terms.y * depth + depth_terms.z / depth;
  out_id = LAYER | number;
}
