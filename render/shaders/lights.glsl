// Lighting of a surface point, by lights at the camera or of the caller's own.
#ifdef LIGHTS
uniform vec3 lights[LIGHTS], light_colors[LIGHTS];  // positions in view space
#endif

#ifndef OWN_VECTORS
// The directions to the viewer and to a light from the pixel's own point, and the half vector, of any length.
vec3 viewer(Surface x, vec2 at) { return ray_to_viewer(at); }
vec3 half_vector(Surface x, vec2 at, vec3 l) { return l + ray_to_viewer(at); }
#ifdef LIGHTS
void light_vectors(Surface x, vec2 at, vec3 light, out vec3 l, out vec3 h) {
  l = normalize(light - vec3((axis_offset + at / axis_scale) * reach(x.depth), -x.depth));
  h = l + ray_to_viewer(at);
}
#endif
#endif

// Diffuse and specular light of all lights together; n faces the viewer.
vec3 lit_at(vec3 albedo, vec3 n, Surface x, vec2 at) {
#ifdef LIGHTS
  vec3 c = albedo * (0.10 + 0.05 * n.y);
  for (int i = 0; i < LIGHTS; ++i) {
    vec3 l, h;
    light_vectors(x, at, lights[i], l, h);
    c += light_colors[i] * (0.85 * albedo * max(dot(n, l), 0.0) + 0.25 * glint(n, h) * step(0.0, dot(n, l)));
  }
  return c;
#else
  return lit(albedo, n, viewer(x, at), half_vector(x, at, kKeyLight));
#endif
}
