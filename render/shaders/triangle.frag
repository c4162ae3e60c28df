uniform uint first_number;
layout(location = 0) out uint out_id;
#if defined(OWN_COLORS) || defined(HIDDEN_FACES)
// A color a face, as words (scene.h).
uniform usamplerBuffer triangle_faces, colors;
uniform int first_triangle, first_face;
int own_face() { return first_face + int(texelFetch(triangle_faces, first_triangle + gl_PrimitiveID).x); }
#endif
#ifdef AT_ONCE
uniform vec2 pixel;  // 2 / picture
in vec3 normal;
layout(location = 1) out vec4 out_color;
#ifdef OWN_COLORS
uniform uint first_primitive;
vec3 triangle_color() {
  int face = own_face();
  return own_color(texelFetch(colors, face).x, uint(face) + 1u, first_primitive + uint(gl_PrimitiveID) + 1u);
}
#else
uniform vec3 run_color;
vec3 triangle_color() { return run_color; }
#endif
#endif

void main() {
#ifdef HIDDEN_FACES
  if (texelFetch(colors, own_face()).x >> 24 == 0u) discard;
#endif
  out_id = (first_number + uint(gl_PrimitiveID)) | kTriangle;
#ifdef AT_ONCE
  out_color = color_at_once(normalize(normal), triangle_color(), gl_FragCoord.xy * pixel - 1.0, 0.0);
#endif
}
