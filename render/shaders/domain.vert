// The box of a domain's rectangle and heights.
uniform samplerBuffer domains;
flat out uint number;
flat out int domain, instance;

const int kDomainTexels = 5;
const int kCorners[36] = int[36](0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5);

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  number = uint(gl_VertexID / 36);
  int corner = kCorners[gl_VertexID % 36];
  uvec4 run = run_of(number);
  instance = int(run.y);
  domain = int(run.z + number - run.x);
  int at = domain * kDomainTexels;
  vec4 t0 = texelFetch(domains, at), t1 = texelFetch(domains, at + 1), t2 = texelFetch(domains, at + 2);
  float lo = t2.w, hi = texelFetch(domains, at + 3).x;
#ifndef HEIGHTS
  lo = hi = 0.0;
#endif
  float slack = (hi - lo) / 255.0 + 1e-4 * min(t0.w, t1.w);
  vec3 p = t0.xyz + ((corner & 1) != 0 ? t0.w : -t0.w) * t1.xyz + ((corner & 2) != 0 ? t1.w : -t1.w) * t2.xyz +
           ((corner & 4) != 0 ? hi + slack : lo - slack) * cross(t1.xyz, t2.xyz);
  vec3 r = (p - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
  cut_nothing();  // domain.frag does, where the surface is
}
