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

void test_arc(vec2 r, vec2 p, vec4 a01, vec4 a2w, float rounding, inout bool inside, inout bool near) {
  vec2 p0 = a01.xy, p1 = a01.zw, p2 = a2w.xy;
  float side;
  inside = inside != crosses(r, p, p0, p2, side);
  // In the bulge if 0 <= b1² < 4 w² b0 b2 in barycentric coordinates; b1's sign is the chord's side, by the same expression.
  vec2 e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0, d = p - p1;
  float area = cross2(e2, -e1), b0 = cross2(e0, d), b2 = cross2(e2, d), b1 = -side, sharp = 4.0 * a2w.z * a2w.z;
  float g = sharp * b0 * b2 - b1 * b1;
  bool between = area > 0.0 ? min(b0, b2) >= 0.0 : max(b0, b2) <= 0.0;
  bool bulge = between && (side > 0.0) == (area < 0.0);
  inside = inside != (bulge && g > 0.0);
  vec2 gradient = sharp * (e0 * b2 + e2 * b0) - 2.0 * b1 * e1;  // turned by a right angle
  near = near || (bulge && g * g <= rounding * rounding * dot(gradient, gradient));
}

#ifdef PLANES
bool planes_contain(int at, uint meta, vec3 p, float rounding) {
  int planes = int((meta >> 16) & 255u);
  for (int i = 0; i < planes; ++i)
    if (dot(heap_texel(at + 1 + i), vec4(p, 1.0)) < -rounding) return false;
  return true;
}

#endif

#if defined(LINES) || defined(ARCS) || defined(ELLIPSES)
bool pieces_contain(int at, uint meta, vec2 p, float rounding) {
  uvec4 head = texelFetch(heap, at);
  vec2 r = uintBitsToFloat(head.zw);
  bool inside = (meta & kReferenceInside) != 0u, near = false;
  at += 1 + int((meta >> 16) & 255u);
  int lines = int(head.x & 4095u), arcs = int((head.x >> 12) & 4095u), ellipses = int(head.x >> 24);
  float side;
#ifdef LINES
  for (int i = 0; i < lines; ++i) {
    vec4 l = heap_texel(at + i);
    inside = inside != crosses(r, p, l.xy, l.zw, side);
    near = near || near_segment(p, l.xy, l.zw, side, rounding);
  }
  at += lines;
#endif
#ifdef ARCS
  for (int i = 0; i < arcs; ++i) test_arc(r, p, heap_texel(at + 2 * i), heap_texel(at + 2 * i + 1), rounding, inside, near);
  at += 2 * arcs;
#endif
#ifdef ELLIPSES
  for (int i = 0; i < ellipses; ++i) {
    vec4 e = heap_texel(at + 2 * i);
    float myy = heap_texel(at + 2 * i + 1).x;
    vec2 d = p - e.xy, q = vec2(e.z * d.x + e.w * d.y, e.w * d.x + myy * d.y);
    float g = 1.0 - dot(q, q);
    inside = inside != (g > 0.0);
    near = near || abs(g) <= 2.0 * rounding * length(vec2(e.z * q.x + e.w * q.y, e.w * q.x + myy * q.y));
  }
#endif
  return inside || near;
}
#endif

#ifdef FLAT_ARCS
flat in vec4 arcs[2 * FLAT_ARCS];
flat in vec2 reference;
bool flat_arcs_contain(uint meta, vec2 p, float rounding) {
  bool inside = (meta & kReferenceInside) != 0u, near = false;
  for (int i = 0; i < FLAT_ARCS; ++i) test_arc(reference, p, arcs[2 * i], arcs[2 * i + 1], rounding, inside, near);
  return inside || near;
}
#endif

#ifdef PIECES
bool bounded(int at, uint meta, vec3 p, float rounding) {
#ifdef PLANES
  if (!planes_contain(at, meta, p, rounding)) return false;
#endif
#if defined(LINES) || defined(ARCS) || defined(ELLIPSES)
  return pieces_contain(at, meta, p.xy, rounding);
#else
  return true;
#endif
}
#endif
