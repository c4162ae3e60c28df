// Colors drawn together with the ids, where a picture needs nothing else of a surface than its normal and a color of the primitive's.
#ifdef AT_ONCE
uniform vec2 axis_scale, axis_offset;  // as in shade_head.glsl
uniform uint only_color;

// A covector of a DP's frame in view space; p, q, f are the slot's.
vec3 to_view(vec3 n, vec3 p, vec3 q, vec3 f) {
  vec2 xy = vec2(dot(n, p), dot(n, q)) * axis_scale;
  return vec3(xy, spread * dot(axis_offset, xy) - dot(n, f));
}

vec3 own_color(uint color, uint face, uint primitive) {
#if SHADING == 7 || SHADING == 8
  vec3 c = number_color(SHADING == 7 ? face : primitive);
  return is_highlighted(color) ? mix(c, from_srgb(color), kHighlight) : c;
#else
  return from_srgb(only_color != 0u && !is_highlighted(color) ? only_color : color);
#endif
}

// n is unit, in view space, of either side.
vec4 color_at_once(vec3 n, vec3 color, vec4 sight, vec2 from, float edge) {
  vec3 v = normalize(vec3(sight.xy + from * sight.zw, 1.0));
  n = dot(n, v) < 0.0 ? -n : n;
#if SHADING == 6
  vec3 c = zebra(n, v);
#else
  vec3 c = lit(color, n, v);
#endif
  return vec4(mix(c, 0.06 * c, 0.9 * edge), 1.0);
}
#endif
