uniform int instance;
layout(location = 0) in vec3 position;

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  vec3 r = (position - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
}
