// Differential points and splats (Kalaiah & Varshney 2003). SPLAT -1: a point's rectangle, with the normals of eq. 10 or of the maps; else a
// splat, shaded once, as at its middle.
uniform samplerBuffer points;
uniform usamplerBuffer colors;
#ifdef NORMAL_MAPS
uniform sampler2DArray normal_maps;  // normal_maps.h
uniform float pixel_size;            // in model units at depth 1, or of a parallel view
#endif

// What the published lighting refers to: the point's position in view space, and the pixel's offset from it in the point's plane.
vec3 own_center, own_offset;

vec3 view_position(Placed placed, vec3 from_s, float depth) {
  vec2 clip = vec2(dot(placed.row_x, from_s), dot(placed.row_y, from_s));
  return vec3(clip / axis_scale + axis_offset * reach(depth), -depth);
}

#ifdef OWN_VECTORS
// Vectors of length 1 at the point and their first derivatives over its plane (eq. 13, 14): exact at the point, linear around it. W is the
// viewer's, L a light's, H = L + W; what is far away does not turn.
vec3 turned(vec3 unit, float way) { return (dot(unit, own_offset) * unit - own_offset) / way; }
vec3 viewer_field() {
  if (spread == 0.0) return vec3(0.0, 0.0, 1.0);
  float way = length(own_center);
  vec3 w = -own_center / way;
  return w + turned(w, way);
}
vec3 viewer(Surface x, vec2 at) { return normalize(viewer_field()); }
vec3 half_vector(Surface x, vec2 at, vec3 l) { return l + viewer_field(); }
#ifdef LIGHTS
void light_vectors(Surface x, vec2 at, vec3 light, out vec3 l, out vec3 h) {
  vec3 to_light = light - own_center;
  float way = length(to_light);
  vec3 unit = to_light / way;
  l = normalize(unit - own_offset / way);  // the papers print it for a light at distance 1
  h = unit + turned(unit, way) + viewer_field();
}
#endif
#endif

#if SPLAT < 0
// (n.x, n.y) / n.z of the normal field at (x, y) of the rectangle.
vec2 normal_slope(float lambda_u, float lambda_v, vec2 p, float depth) {
#ifdef NORMAL_MAPS
  float rho = lambda_u != 0.0 ? lambda_v / lambda_u : 0.0, map = floor(128.5 + 127.0 * clamp(rho, -1.0, 1.0));
  float quantised = (map - 128.0) / 127.0;
  vec2 reach_of_map = vec2(1.0, 1.0 / max(abs(quantised), 0.5 / 127.0)), at = clamp(lambda_u * p / reach_of_map, -1.0, 1.0);
  const float size = 32.0;
  float texels = abs(lambda_u) * pixel_size * reach(depth) * 0.5 * (size - 1.0);
  return textureLod(normal_maps, vec3(0.5 + 0.5 * at * (size - 1.0) / size, map), log2(max(texels, 1e-6))).xy;
#else
  float r2 = dot(p, p), sine = r2 > 0.0 ? (lambda_u * p.x * p.x + lambda_v * p.y * p.y) * inversesqrt(r2) : 0.0, a = abs(sine);
  float stretch = a < 0.05 ? 1.0 + a * a / 6.0 : asin(min(a, 1.0)) / a;
  return -vec2(lambda_u, lambda_v) * p * stretch;
#endif
}

Surface surface_at(uint number, vec2 at) {
  uvec4 run = run_of(own_number(number));
  uint point = run.z + own_number(number) - run.x;
  vec4 t0 = texelFetch(points, int(point) * 3), t1 = texelFetch(points, int(point) * 3 + 1), t2 = texelFetch(points, int(point) * 3 + 2);
  Placed placed = placed_at(int(run.y), at);
  vec3 u = t1.xyz, v = t2.xyz, n = cross(u, v), from_s = (t0.xyz - placed.hi) - placed.lo, to_center = from_s - placed.origin;
  float slant = dot(n, placed.direction), t = dot(n, to_center) / (slant != 0.0 ? slant : 1e-30);
  vec3 offset = t * placed.direction - to_center;
  vec2 p = vec2(dot(offset, u), dot(offset, v));
  Surface result;
  result.depth = start_depth + t;
  vec2 slope = normal_slope(t1.w, t2.w, p, result.depth);
  result.normal = normalize(placed.to_view * (n + slope.x * u + slope.y * v));
  result.face = placed.first_face + floatBitsToUint(t0.w) + 1u;
  result.primitive = run.w + point - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
  result.edge = 0.0;
  result.direction = vec3(0.0);
  result.curvature = vec2(0.0);
#ifdef CURVES
  vec3 gradient = placed.to_view * n;
  mat3 to_local = transpose(mat3(u, v, n)) * transpose(placed.to_view);
  principal_curvatures(normalize(gradient), length(gradient), to_local, vec4(t1.w, t2.w, 0.0, 0.0), 0.0, result.curvature, result.direction);
#endif
  own_center = view_position(placed, from_s, start_depth + dot(placed.depth_row, from_s));
  own_offset = view_position(placed, from_s + offset, result.depth) - own_center;
  return result;
}

#else

Surface surface_at(uint number, vec2 at) {
  uvec4 run = run_of(own_number(number));
  uint point = run.z + own_number(number) - run.x;
  vec4 t0 = texelFetch(points, int(point) * 2), t1 = texelFetch(points, int(point) * 2 + 1);
  Placed placed = placed_at(int(run.y), at);
  vec3 from_s = (t0.xyz - placed.hi) - placed.lo;
  Surface result;
  result.normal = normalize(placed.to_view * t1.xyz);
  result.depth = start_depth + dot(placed.depth_row, from_s);
  result.face = placed.first_face + floatBitsToUint(t1.w) + 1u;
  result.primitive = run.w + point - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
  result.edge = 0.0;
  result.direction = vec3(0.0);
  result.curvature = vec2(0.0);
  own_center = view_position(placed, from_s, result.depth);
  own_offset = vec3(0.0);
  return result;
}
#endif
