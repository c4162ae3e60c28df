// A region's boundary pieces and planes, tested point by point: the twin of sampling/region.cpp, in float, where a point within
// `rounding` of the boundary counts as inside.

// Whether the segment from r to p crosses a–b. `side` tells on which side of a–b p lies.
bool crosses(vec2 r, vec2 p, vec2 a, vec2 b, out float side) {
  vec2 d = p - r, ab = b - a;
  side = cross2(ab, p - a);
  bool between = (cross2(d, a - r) > 0.0) != (cross2(d, b - r) > 0.0);
  return between && ((side > 0.0) != (cross2(ab, r - a) > 0.0));
}

bool near_segment(vec2 p, vec2 a, vec2 b, float side, float rounding) {
  vec2 ab = abs(b - a);
  return abs(side) <= rounding * max(ab.x, ab.y) && dot(p - a, p - b) <= 0.0;
}

bool planes_contain(int at, uint meta, vec3 p, float rounding) {
  int planes = int((meta >> 16) & 255u);
  for (int i = 0; i < planes; ++i)
    if (dot(heap_texel(at + 1 + i), vec4(p, 1.0)) < -rounding) return false;
  return true;
}

bool pieces_contain(int at, uint meta, vec2 p, float rounding) {
  uvec4 head = texelFetch(heap, at);
  vec2 r = uintBitsToFloat(head.zw);
  bool inside = (meta & kReferenceInside) != 0u, near = false;
  at += 1 + int((meta >> 16) & 255u);
  int lines = int(head.x & 4095u), arcs = int((head.x >> 12) & 4095u), ellipses = int(head.x >> 24);
  float side;
  for (int i = 0; i < lines; ++i) {
    vec4 l = heap_texel(at + i);
    inside = inside != crosses(r, p, l.xy, l.zw, side);
    near = near || near_segment(p, l.xy, l.zw, side, rounding);
  }
  at += lines;
  for (int i = 0; i < arcs; ++i) {
    vec4 a01 = heap_texel(at + 2 * i), a2w = heap_texel(at + 2 * i + 1);
    vec2 p0 = a01.xy, p1 = a01.zw, p2 = a2w.xy;
    inside = inside != crosses(r, p, p0, p2, side);
    // In the bulge if 0 <= b1² < 4 w² b0 b2 in barycentric coordinates; b1's sign is the chord's side, by the same expression.
    float area = cross2(p1 - p0, p2 - p0);
    float b0 = cross2(p1 - p, p2 - p), b2 = cross2(p0 - p, p1 - p), b1 = -side, sharp = 4.0 * a2w.z * a2w.z;
    float g = sharp * b0 * b2 - b1 * b1;
    bool between = area > 0.0 ? b0 >= 0.0 && b2 >= 0.0 : b0 <= 0.0 && b2 <= 0.0;
    bool bulge = (side > 0.0) == (area < 0.0);
    inside = inside != (between && bulge && g > 0.0);
    // |∇g| by the edges opposite to the corners.
    vec2 e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
    vec2 gradient = sharp * (e0 * b2 + e2 * b0) - 2.0 * b1 * e1;
    near = near || (between && bulge && abs(g) <= rounding * length(gradient));
  }
  at += 2 * arcs;
  for (int i = 0; i < ellipses; ++i) {
    vec4 e = heap_texel(at + 2 * i);
    float myy = heap_texel(at + 2 * i + 1).x;
    vec2 d = p - e.xy, q = vec2(e.z * d.x + e.w * d.y, e.w * d.x + myy * d.y);
    float g = 1.0 - dot(q, q);
    inside = inside != (g > 0.0);
    near = near || abs(g) <= 2.0 * rounding * length(vec2(e.z * q.x + e.w * q.y, e.w * q.x + myy * q.y));
  }
  return inside || near;
}
