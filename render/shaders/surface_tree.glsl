// What a point tree shows under a pixel: a node as the second-order surface that it stands for, or a triangle.
uniform usamplerBuffer points;         // a node each
uniform usamplerBuffer point_extras;   // each point's curvature (the highest 8 bits: times this / 255), number of the node, face, the normal that the curvature's axis counts from
uniform usamplerBuffer drawn_triangles;  // each drawn triangle's: index into triangles, face
uniform usamplerBuffer vertices;       // place, place, normal, color
uniform usamplerBuffer triangles;      // three vertices, number in the tree
uniform samplerBuffer grids;           // of each placement: origin, step | nodes of the tree (bits), 1 if it has colors, -, -
uniform usamplerBuffer colors;
uniform int point_runs;                // of the runs; those of triangles follow

const uint kHole = 1u << 25, kTriangleOf = 1u << 26, kIndexMask = kHole - 1u;

// runs.glsl's search in one of the two lists.
uvec4 run_between(uint number, int lo, int hi) {
  while (lo < hi) {
    int middle = (lo + hi + 1) >> 1;
    if (texelFetch(runs, middle).x <= number) lo = middle; else hi = middle - 1;
  }
  return texelFetch(runs, lo);
}

float point_reach;  // how far, in depth, the sphere of the last point reaches

// `face` has the highest bit set where the face's color is not the tree's.
Surface finish(Surface result, Placed placed, vec4 grid, uint face, uint color) {
  result.face = placed.first_face + (face & 0x7fffffffu) + 1u;
  result.color = grid.y > 0.5 && face >> 31 == 0u ? color : texelFetch(colors, int(result.face) - 1).x;
  result.edge = 0.0;
  return result;
}

Surface point_surface(uint index, vec2 at) {
  uvec4 run = run_between(index, 0, point_runs - 1);
  int instance = int(run.y);
  Placed placed = placed_at(instance, at);
  vec4 grid = texelFetch(grids, 2 * instance), more = texelFetch(grids, 2 * instance + 1);
  uvec4 node = texelFetch(points, int(index));
  uvec4 extra = texelFetch(point_extras, int(index));
  vec3 n = node_normal(node.w), center = grid.xyz + grid.w * node_place(node.xy);
  float radius = grid.w * node_radius(node.z);

  // From where the ray passes the centre along itself onto the tangent plane, though not beyond the sphere.
  vec3 d = placed.direction, to_center = (center - placed.hi) - placed.lo - placed.origin;
  float dd = dot(d, d);
  vec3 aside = d * (dot(to_center, d) / dd) - to_center;
  float slant = dot(n, d);
  vec3 offset = aside - d * (abs(slant) > 1e-6 * sqrt(dd) ? dot(aside, n) / slant : 0.0);
  offset -= n * dot(offset, n);
  float far = length(offset);
  if (far > radius) offset *= radius / max(far, 1e-30);

  Surface result;
  vec2 k = vec2(signed_square(extra.x & 0xffu), signed_square(extra.x >> 8 & 0xffu)) * (float(extra.x >> 24) / 255.0) / max(radius, 1e-30);
  float angle = float(extra.x >> 16 & 0xffu) * (3.14159265358979 / 256.0);
  vec3 m = node_normal(extra.w), x = node_axis(m), e1 = cos(angle) * x + sin(angle) * cross(m, x);
  e1 -= n * dot(n, e1);
  e1 = dot(e1, e1) > 1e-12 ? normalize(e1) : node_axis(n);
  vec3 e2 = cross(n, e1);
  vec2 p = vec2(dot(offset, e1), dot(offset, e2));
  vec3 normal = n - k.x * p.x * e1 - k.y * p.y * e2;
  // A point whose middle is seen shows no back: beyond the outline its normals stay perpendicular to the ray.
  if (slant < 0.0) normal -= d * (max(0.0, dot(normal, d)) / dd);
  result.normal = normalize(placed.to_view * normal);
  result.depth = depth_of(placed, center + offset + n * (0.5 * dot(k, p * p)));
  result.curvature = k * length(placed.to_view[0]);  // per model unit: covectors shrink as placements stretch
  point_reach = radius * length(placed.depth_row);
  result.direction = normalize(placed.to_view * e1);
  result.primitive = run.w + extra.y + 1u;
  return finish(result, placed, more, extra.z, node_color(node.z, node.w));
}

vec3 color_vector(uint word) { return vec3(float(word & 0xffu), float(word >> 8 & 0xffu), float(word >> 16 & 0xffu)); }

Surface triangle_surface(uint index, vec2 at) {
  uvec4 run = run_between(index, point_runs, run_count - 1);
  int instance = int(run.y);
  Placed placed = placed_at(instance, at);
  vec4 grid = texelFetch(grids, 2 * instance), more = texelFetch(grids, 2 * instance + 1);
  uvec2 drawn = texelFetch(drawn_triangles, int(index)).xy;
  uvec4 triangle = texelFetch(triangles, int(drawn.x));
  uvec4 va = texelFetch(vertices, int(triangle.x)), vb = texelFetch(vertices, int(triangle.y)), vc = texelFetch(vertices, int(triangle.z));
  vec3 a = grid.xyz + grid.w * node_place(va.xy);
  vec3 e1 = grid.w * (node_place(vb.xy) - node_place(va.xy)), e2 = grid.w * (node_place(vc.xy) - node_place(va.xy));

  // As in surface_mesh.glsl.
  vec3 d = placed.direction, from_a = (placed.hi - a) + placed.lo + placed.origin;
  vec3 h = cross(d, e2), q = cross(from_a, e1);
  float det = dot(e1, h);
  vec2 uv = det != 0.0 ? vec2(dot(from_a, h), dot(d, q)) / det : vec2(1.0 / 3.0);
  uv = clamp(uv, 0.0, 1.0);
  uv /= max(1.0, uv.x + uv.y);
  vec3 na = node_normal(va.z), n = na + uv.x * (node_normal(vb.z) - na) + uv.y * (node_normal(vc.z) - na);

  Surface result;
  result.normal = normalize(placed.to_view * n);
  result.depth = depth_of(placed, a + uv.x * e1 + uv.y * e2);
  result.curvature = vec2(0.0);
  result.direction = vec3(0.0);
  result.primitive = run.w + floatBitsToUint(more.x) + triangle.w + 1u;
  vec3 ca = color_vector(va.w), c = ca + uv.x * (color_vector(vb.w) - ca) + uv.y * (color_vector(vc.w) - ca);
  uvec3 bytes = uvec3(clamp(c + 0.5, 0.0, 255.0));
  return finish(result, placed, more, drawn.y, bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u);
}

Surface one_surface(uint own, vec2 at) {
  return (own & kTriangleOf) != 0u ? triangle_surface(own & (kTriangleOf - 1u), at) : point_surface(own & kIndexMask, at);
}

#ifdef RECONSTRUCT
// A pixel without a point of its own is made from those around it, weighted by how near they are, as far as they belong to the
// surface that is there.
uniform int filter_radius;
Surface surface_at(uint number, vec2 at) {
  uint own = own_number(number);
  if ((own & kTriangleOf) != 0u || (own & kHole) == 0u) return one_surface(own, at);
  Surface here = point_surface(own & kIndexMask, at), result = here;
  ivec2 where = ivec2(gl_FragCoord.xy), size = textureSize(ids, 0);
  vec3 normal = vec3(0.0), color = vec3(0.0);
  float depth = 0.0, sum = 0.0, nearest = 1e9, tolerance = 4.0 * point_reach;
  for (int dy = -filter_radius; dy <= filter_radius; ++dy)
    for (int dx = -filter_radius; dx <= filter_radius; ++dx) {
      ivec2 there = where + ivec2(dx, dy);
      if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) continue;
      uint other = texelFetch(ids, there, 0).x;
      if (!is_mine(other) || ((own_number(other) & kTriangleOf) == 0u && (own_number(other) & kHole) != 0u)) continue;
      Surface s = one_surface(own_number(other), at + vec2(dx, dy) * pixel);
      if (abs(s.depth - here.depth) > tolerance) continue;
      float apart = float(dx * dx + dy * dy), weight = exp(-2.0 * apart / float(filter_radius * filter_radius));
      normal += weight * s.normal, color += weight * color_vector(s.color), depth += weight * s.depth, sum += weight;
      if (apart < nearest) nearest = apart, result = s;
    }
  if (sum <= 0.0) return here;
  result.normal = normalize(normal);
  result.depth = depth / sum;
  uvec3 bytes = uvec3(clamp(color / sum + 0.5, 0.0, 255.0));
  result.color = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
  return result;
}
#else
Surface surface_at(uint number, vec2 at) { return one_surface(own_number(number), at); }
#endif
