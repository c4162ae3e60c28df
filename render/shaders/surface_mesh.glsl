// A triangle's point under a pixel, with the normal interpolated from its corners.
uniform samplerBuffer vertices;        // three texels each: x, y | z, nx | ny, nz
uniform usamplerBuffer indices, triangle_faces, colors;

bool is_mine(uint number) { return number >> 30 == kTriangle >> 30; }

void fetch_vertex(uint index, out vec3 position, out vec3 normal) {
  int at = int(index) * 3;
  vec2 a = texelFetch(vertices, at).xy, b = texelFetch(vertices, at + 1).xy, c = texelFetch(vertices, at + 2).xy;
  position = vec3(a, b.x);
  normal = vec3(b.y, c);
}

Surface surface_at(uint number, vec2 at) {
  number &= kTriangleMask;
  uvec4 run = run_of(number);
  int triangle = int(run.z + number - run.x), instance = int(run.y) * kInstanceTexels;
  vec3 a, b, c, na, nb, nc;
  fetch_vertex(texelFetch(indices, 3 * triangle).x, a, na);
  fetch_vertex(texelFetch(indices, 3 * triangle + 1).x, b, nb);
  fetch_vertex(texelFetch(indices, 3 * triangle + 2).x, c, nc);

  vec4 hi = texelFetch(instances, instance);
  vec3 lo = texelFetch(instances, instance + 1).xyz, f = texelFetch(instances, instance + 2).xyz;
  vec3 p = texelFetch(instances, instance + 3).xyz, q = texelFetch(instances, instance + 4).xyz;
  vec3 across = at.x * p + at.y * q, from_a = (hi.xyz - a) + lo + start * across, d = f + spread * across;
  // Barycentric coordinates of where the ray meets the plane (Möller and Trumbore), kept inside: a triangle seen edge-on has none.
  vec3 e1 = b - a, e2 = c - a, h = cross(d, e2), k = cross(from_a, e1);
  float det = dot(e1, h);
  vec2 uv = det != 0.0 ? vec2(dot(from_a, h), dot(d, k)) / det : vec2(1.0 / 3.0);
  uv = clamp(uv, 0.0, 1.0);
  uv /= max(1.0, uv.x + uv.y);
  vec3 n = na + uv.x * (nb - na) + uv.y * (nc - na);
  vec3 from_s = (a - hi.xyz) - lo + uv.x * e1 + uv.y * e2;

  vec3 right = p * axis_scale.x, up = q * axis_scale.y;
  vec3 back = spread * (axis_offset.x * right + axis_offset.y * up) - f;
  Surface result;
  result.normal = normalize(vec3(dot(n, right), dot(n, up), dot(n, back)));
  result.depth = start_depth + dot(texelFetch(instances, instance + 7).xyz, from_s);
  result.direction = vec3(0.0);
  result.curvature = vec2(0.0);
  result.face = floatBitsToUint(hi.w) + texelFetch(triangle_faces, triangle).x + 1u;
  result.primitive = run.w + uint(triangle) - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
  result.edge = 0.0;
  return result;
}
