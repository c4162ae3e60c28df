// A domain's rectangle, in its plane.
uniform samplerBuffer domains;
uniform usamplerBuffer order;  // number, instance, record, whether its n is outward
flat out uint number;
flat out int domain, instance, oriented;

const int kDomainTexels = 5;
const int kCorners[6] = int[6](0, 1, 2, 2, 1, 3);

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  uvec4 entry = texelFetch(order, gl_VertexID / 6);
  number = entry.x;
  instance = int(entry.y);
  domain = int(entry.z);
  oriented = int(entry.w);
  int corner = kCorners[gl_VertexID % 6], at = domain * kDomainTexels;
  vec4 t0 = texelFetch(domains, at), t1 = texelFetch(domains, at + 1), t2 = texelFetch(domains, at + 2);
  vec3 p = t0.xyz + ((corner & 1) != 0 ? t0.w : -t0.w) * t1.xyz + ((corner & 2) != 0 ? t1.w : -t1.w) * t2.xyz;
  vec3 r = (p - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
}
