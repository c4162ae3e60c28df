// A differential point's rectangle, by its corners.
uniform int instance;
uniform uint first_number;
layout(location = 0) in vec3 corner;
flat out uint number;

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  number = first_number + uint(gl_VertexID >> 2);
  vec3 r = (corner - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
}
