flat in uint number;
#if SPLAT == 2
uniform sampler2DArray ellipses;
flat in float slimness;
in vec2 place;
#endif
layout(location = 0) out uint out_id;

void main() {
#if SPLAT == 2
  if (texture(ellipses, vec3(0.5 + 0.5 * place, slimness)).x > 0.5) discard;
#endif
  out_id = LAYER | number;
}
