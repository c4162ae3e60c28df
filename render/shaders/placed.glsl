// A pixel's ray in the space of a placed part, relative to its anchor and to where rays start, S: origin + t direction, t its depth beyond
// start_depth.
void ray_of(int instance, vec2 at, out vec3 origin, out vec3 direction) {
  int first = instance * kInstanceTexels;
  vec3 across = at.x * texelFetch(instances, first + 3).xyz + at.y * texelFetch(instances, first + 4).xyz;
  origin = start * across;
  direction = texelFetch(instances, first + 2).xyz + spread * across;
}
// A point of the part, relative to S.
vec3 from_start(int instance, vec3 p) {
  int first = instance * kInstanceTexels;
  return (p - texelFetch(instances, first).xyz) - texelFetch(instances, first + 1).xyz;
}
