uniform int instance;
layout(location = 0) in vec3 position;
#ifdef AT_ONCE
layout(location = 1) in vec3 corner_normal;
out vec3 normal;
flat out vec4 sight;
flat out vec2 centre;
#ifndef OWN_COLORS
uniform vec3 run_color;
flat out vec3 own;
#endif
#endif

vec3 instance_texel(int i) { return texelFetch(instances, instance * kInstanceTexels + i).xyz; }

void main() {
  vec3 r = (position - instance_texel(0)) - instance_texel(1);
  gl_Position = to_clip(vec2(dot(instance_texel(5), r), dot(instance_texel(6), r)), start_depth + dot(instance_texel(7), r));
#ifdef AT_ONCE
  centre = 0.5 * picture;
  sight = sight_from(centre);
#ifndef OWN_COLORS
  own = run_color;
#endif
  normal = to_view(corner_normal, instance_texel(3), instance_texel(4), instance_texel(2));
#endif
}
