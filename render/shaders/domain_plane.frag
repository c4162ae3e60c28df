// A domain's share of the prefix, or, where pixels are locked, the number of the domain that locks them: which of the two is kept is a matter of
// masks.
uniform vec2 pixel;
uniform vec3 depth_terms;
uniform float least_psi;
flat in uint number;
flat in int domain, instance, oriented;
layout(location = 0) out uint out_id;
layout(location = 1) out vec4 out_normal;  // in the part's space; Ψ
layout(location = 2) out vec4 out_color;

void main() {
  vec2 at = gl_FragCoord.xy * pixel - 1.0;
  vec3 origin, direction;
  ray_of(instance, at, origin, direction);
  Domain d = domain_at(domain);
  vec3 o = in_domain(d, origin - from_start(instance, d.center)), w = in_domain(d, direction);
  float t = -o.z / w.z;
  vec2 xy = o.xy + t * w.xy;
  // Vertices are rounded: what is just outside of the rectangle may be covered.
  if (!(t > 0.0) || any(greaterThan(abs(xy), vec2(1.0)))) discard;
  vec4 color_psi = color_psi_at(d, xy);
  if (color_psi.w <= least_psi) discard;
  vec3 n = local_normal(d, normal_height_at(d, xy));
  if (oriented == 0 && w.z > 0.0) n = -n;
  float depth = start_depth + t;
  gl_FragDepth = depth_terms.x + depth_terms.y * depth + depth_terms.z / depth;
  out_id = LAYER | number;
  out_normal = vec4(color_psi.w * n, color_psi.w);
  out_color = vec4(color_psi.w * color_psi.xyz, color_psi.w);
}
