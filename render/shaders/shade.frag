// Once a pixel: from the number of the primitive that is seen there to everything that is asked for.
#ifdef COLOR
layout(location = LOCATION_COLOR) out vec4 out_color;
#endif
#ifdef NORMAL_DEPTH
layout(location = LOCATION_NORMAL_DEPTH) out vec4 out_normal_depth;
#endif
#ifdef CURVATURE
layout(location = LOCATION_CURVATURE) out vec2 out_curvature;
layout(location = LOCATION_DIRECTION) out vec4 out_direction;
#endif
#ifdef NUMBERS_PICTURE
layout(location = LOCATION_NUMBERS) out uvec2 out_numbers;
#endif

#ifdef EXACT_CURVATURES
uniform sampler2D curvatures;  // larger than 1e37 where only the primitive knows
#endif

#ifdef COLOR
vec3 picture_color(Surface x, vec2 at) {
  vec3 v = viewer(x, at);
  vec3 n = dot(x.normal, v) < 0.0 ? -x.normal : x.normal;
#if SHADING == 0
  vec3 c = lit_at(from_srgb(only_color != 0u && !is_highlighted(x.color) ? only_color : x.color), n, x, at);
#elif SHADING == 1
  vec3 m = to_model * x.normal;
  vec3 c = pow(0.5 + 0.5 * m, vec3(2.2));
#elif SHADING == 2
  vec3 c = diverging(x.curvature.x / (curvature_scale + abs(x.curvature.x)));
#elif SHADING == 3
  vec3 c = diverging(x.curvature.y / (curvature_scale + abs(x.curvature.y)));
#elif SHADING == 4
  float h = 0.5 * (x.curvature.x + x.curvature.y);
  vec3 c = diverging(h / (curvature_scale + abs(h)));
#elif SHADING == 5
  float k = x.curvature.x * x.curvature.y, r = sign(k) * sqrt(abs(k));
  vec3 c = diverging(r / (curvature_scale + abs(r)));
#elif SHADING == 6
  vec3 c = zebra(n, v);
#elif SHADING == 7
  vec3 c = lit_at(number_color(x.face), n, x, at);
#else
  vec3 c = lit_at(number_color(x.primitive), n, x, at);
#endif
#if SHADING >= 2 && SHADING <= 5
  c *= 0.55 + 0.45 * dot(n, v);
#endif
#if SHADING > 0
  if (is_highlighted(x.color)) c = mix(c, lit(from_srgb(x.color), n, v), kHighlight);
#endif
#ifdef CUT
  if (is_solid(x.color) && dot(x.normal, v) < 0.0)
    return hatched(from_srgb(only_color != 0u ? only_color : x.color), gl_FragCoord.xy);
#endif
  return mix(c, 0.06 * c, 0.9 * x.edge);
}
#endif

void main() {
  ivec2 where = ivec2(gl_FragCoord.xy);
  uint number = texelFetch(ids, where, 0).x;
  vec2 at = gl_FragCoord.xy * pixel - 1.0;
  if (!is_mine(number)) discard;
  Surface x = surface_at(number, at);
#ifdef EXACT_CURVATURES
  vec2 exact = texelFetch(curvatures, where, 0).xy;
  if (exact.x < 1e37) x.curvature = exact;
#endif
#ifdef COLOR
  out_color = vec4(picture_color(x, at), 1.0) - under;
#endif
#ifdef NORMAL_DEPTH
  out_normal_depth = vec4(to_model * x.normal, x.depth);
#endif
#ifdef CURVATURE
  out_curvature = x.curvature;
  out_direction = vec4(to_model * x.direction, 0.0);
#endif
#ifdef NUMBERS_PICTURE
  out_numbers = uvec2(x.face, x.primitive);
#endif
}
