flat in uint id;
layout(location = 0) out uint out_id;
#ifdef AT_ONCE
uniform vec2 pixel;  // 2 / picture
flat in vec3 normal, own;
layout(location = 1) out vec4 out_color;
#endif

void main() {
  out_id = id;
#ifdef AT_ONCE
  out_color = color_at_once(normal, own, gl_FragCoord.xy * pixel - 1.0, 0.0);
#endif
}
