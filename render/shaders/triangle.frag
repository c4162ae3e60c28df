uniform uint first_number;
layout(location = 0) out uint out_id;
#if defined(OWN_COLORS) || defined(HIDDEN_FACES)
// A color a face, as words (scene.h).
uniform usamplerBuffer triangle_faces, colors;
uniform int first_triangle, first_face;
int own_face() { return first_face + int(texelFetch(triangle_faces, first_triangle + gl_PrimitiveID).x); }
#endif
#ifdef AT_ONCE
in vec3 normal;
flat in vec4 sight;
flat in vec2 centre;
layout(location = 1) out vec4 out_color;
#ifdef OWN_COLORS
uniform uint first_primitive;
vec3 triangle_color() {
  int face = own_face();
  return own_color(texelFetch(colors, face).x, uint(face) + 1u, first_primitive + uint(gl_PrimitiveID) + 1u);
}
#else
flat in vec3 own;
vec3 triangle_color() { return own; }
#endif
#endif

void main() {
#ifdef HIDDEN_FACES
  if (texelFetch(colors, own_face()).x >> 24 == 0u) discard;
#endif
  out_id = (first_number + uint(gl_PrimitiveID)) | kTriangle;
#ifdef AT_ONCE
  out_color = color_at_once(normalize(normal), triangle_color(), sight, gl_FragCoord.xy - centre, 0.0);
#endif
}
