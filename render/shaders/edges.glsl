// Feature edges: how many pixels a point of the surface is from the nearest piece of its region that is one. A function g of the
// DP's frame is |g| / |∇g| pixels from zero, with ∇g along the picture's axes from how the point moves on the surface, px and py.

float pixels(float g, vec3 gradient, vec3 px, vec3 py) {
  return abs(g) / max(length(vec2(dot(gradient, px), dot(gradient, py))), 1e-30);
}

float segment_pixels(vec2 at, vec2 a, vec2 b, vec3 px, vec3 py) {
  vec2 ab = b - a;
  float l = max(length(ab), 1e-30);
  vec2 u = ab / l;
  float along = dot(at - a, u), beyond = max(max(-along, along - l), 0.0);
  vec3 across = vec3(-u.y, u.x, 0.0), forward = vec3(u, 0.0);
  float g = dot(at - a, across.xy);
  return max(pixels(g, across, px, py), beyond > 0.0 ? pixels(beyond, forward, px, py) : 0.0);
}

float side_pixels(vec2 at, vec2 a, vec2 b, vec3 px, vec3 py) {
  vec2 ab = b - a;
  float l = length(ab);
  if (l == 0.0) return 1e30;
  vec2 n = vec2(-ab.y, ab.x) / l;
  return pixels(dot(at - a, n), vec3(n, 0.0), px, py);
}

float arc_pixels(vec2 at, vec4 a01, vec4 a2w, vec3 px, vec3 py) {
  vec2 p0 = a01.xy, p1 = a01.zw, p2 = a2w.xy;
  float area = cross2(p1 - p0, p2 - p0), sharp = 4.0 * a2w.z * a2w.z;
  if (area == 0.0) return 1e30;
  float b0 = cross2(p1 - at, p2 - at) / area, b2 = cross2(p0 - at, p1 - at) / area, b1 = 1.0 - b0 - b2;
  if (b0 < -0.02 || b2 < -0.02 || b1 < -0.02) return 1e30;
  vec2 e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
  vec2 d0 = vec2(-e0.y, e0.x) / area, d1 = vec2(-e1.y, e1.x) / area, d2 = vec2(-e2.y, e2.x) / area;
  float g = sharp * b0 * b2 - b1 * b1;
  return pixels(g, vec3(sharp * (d0 * b2 + d2 * b0) - 2.0 * b1 * d1, 0.0), px, py);
}

float ellipse_pixels(vec2 at, vec4 e, float myy, vec3 px, vec3 py) {
  vec2 d = at - e.xy, q = vec2(e.z * d.x + e.w * d.y, e.w * d.x + myy * d.y);
  return pixels(dot(q, q) - 1.0, vec3(2.0 * (e.z * q.x + e.w * q.y), 2.0 * (e.w * q.x + myy * q.y), 0.0), px, py);
}

float piece_pixels(int at, uint meta, vec3 x, vec3 px, vec3 py) {
  uvec4 head = texelFetch(heap, at);
  float nearest = 1e30;
  int planes = int((meta >> 16) & 255u), feature_planes = int(meta >> 24);
  for (int i = 0; i < feature_planes; ++i) {
    vec4 plane = heap_texel(at + 1 + i);
    nearest = min(nearest, pixels(dot(plane, vec4(x, 1.0)), plane.xyz, px, py));
  }
  at += 1 + planes;
  int lines = int(head.y & 4095u), arcs = int((head.y >> 12) & 4095u), ellipses = int(head.y >> 24);
  for (int i = 0; i < lines; ++i) {
    vec4 l = heap_texel(at + i);
    nearest = min(nearest, segment_pixels(x.xy, l.xy, l.zw, px, py));
  }
  at += int(head.x & 4095u);
  for (int i = 0; i < arcs; ++i)
    nearest = min(nearest, arc_pixels(x.xy, heap_texel(at + 2 * i), heap_texel(at + 2 * i + 1), px, py));
  at += 2 * int((head.x >> 12) & 4095u);
  for (int i = 0; i < ellipses; ++i)
    nearest = min(nearest, ellipse_pixels(x.xy, heap_texel(at + 2 * i), heap_texel(at + 2 * i + 1).x, px, py));
  return nearest;
}

float edge_pixels(int slot, uint meta, int pieces, vec3 x, vec3 px, vec3 py) {
  float nearest = 1e30;
  vec4 c01 = slot_texel(slot, 6), c23 = slot_texel(slot, 7), t5 = slot_texel(slot, 5);
  uint sides = meta >> 8;
  if ((sides & 1u) != 0u) nearest = min(nearest, side_pixels(x.xy, c01.xy, c01.zw, px, py));
  if ((sides & 2u) != 0u) nearest = min(nearest, side_pixels(x.xy, c01.zw, c23.xy, px, py));
  if ((sides & 4u) != 0u) nearest = min(nearest, side_pixels(x.xy, c23.xy, c23.zw, px, py));
  if ((sides & 8u) != 0u) nearest = min(nearest, side_pixels(x.xy, c23.zw, c01.xy, px, py));
  vec3 z = vec3(0.0, 0.0, 1.0);
  if ((sides & 16u) != 0u) nearest = min(nearest, pixels(x.z - t5.y, z, px, py));
  if ((sides & 32u) != 0u) nearest = min(nearest, pixels(x.z - t5.z, z, px, py));
  if ((meta & kPieces) != 0u) nearest = min(nearest, piece_pixels(pieces, meta, x, px, py));
  return nearest;
}
