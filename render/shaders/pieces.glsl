// A region's boundary pieces and planes, tested point by point: the twin of sampling/region.cpp, in float, where a point within
// `rounding` of the boundary counts as inside.
//
// With EDGES also how far, in pixels, the nearest feature edge is: a function g of the DP's frame is |g| / |∇g| pixels from zero, with
// ∇g along the picture's axes from how the point moves on the surface from pixel to pixel, px and py. Squares are kept.

struct Region {
  vec3 p;           // the point, in the DP's frame
  float rounding;
  bool inside, near;
#ifdef EDGES
  vec3 px, py;
  float nearest;    // squared
#endif
};

#ifdef EDGES
void meet_edge(inout Region at, float g, vec3 gradient) {
  vec2 slope = vec2(dot(gradient, at.px), dot(gradient, at.py));
  at.nearest = min(at.nearest, g * g / max(dot(slope, slope), 1e-37));
}
// An edge that ends: beyond its ends the way past the end counts, too.
void meet_segment(inout Region at, float side, vec2 from_a, vec2 ab) {
  float along = dot(from_a, ab), beyond = max(max(-along, along - dot(ab, ab)), 0.0);
  vec2 across = vec2(-ab.y, ab.x);
  vec2 slope = vec2(dot(across, at.px.xy), dot(across, at.py.xy)), run = vec2(dot(ab, at.px.xy), dot(ab, at.py.xy));
  at.nearest = min(at.nearest, max(side * side / max(dot(slope, slope), 1e-37), beyond * beyond / max(dot(run, run), 1e-37)));
}
#endif

#ifdef EDGES
// The conic goes on beyond the arc: what counts is in or near the triangle. One that is hardly a few pixels high is a parabola over its
// chord: the conic's other parts are near.
void meet_arc(inout Region at, vec2 here, vec2 p0, vec2 e1, float side, float area, float inside, float sharp, float g, vec2 gradient) {
  vec2 normal = vec2(-e1.y, e1.x), slope = vec2(dot(normal, at.px.xy), dot(normal, at.py.xy)),
       run = vec2(dot(e1, at.px.xy), dot(e1, at.py.xy));
  float steep = max(dot(slope, slope), 1e-37);
  if (area * area > 9.0 * steep) {
    if (min(inside, -side) >= -0.02 * area) meet_edge(at, g, vec3(gradient, 0.0));
    return;
  }
  float length2 = max(dot(e1, e1), 1e-37), along = dot(e1, p0 - here), beyond = max(max(-along, along - length2), 0.0);
  float t = clamp(along / length2, 0.0, 1.0), w = 0.5 * sqrt(sharp), off = side + area * (w / (1.0 + w)) * 4.0 * t * (1.0 - t);
  at.nearest = min(at.nearest, max(off * off / steep, beyond * beyond / max(dot(run, run), 1e-37)));
}
#endif

#ifdef PLANES
void test_planes(inout Region at, int texel, int planes, int features) {
  for (int i = 0; i < planes; ++i) {
    vec4 plane = heap_texel(texel + i);
    float g = dot(plane, vec4(at.p, 1.0));
    at.inside = at.inside && g >= -at.rounding;
#ifdef EDGES
    if (i < features) meet_edge(at, g, plane.xyz);
#endif
  }
}
#endif

// Pieces are stored relative to the region's reference, and `here` is the point relative to it: the way between the two crosses a–b if
// a and b lie on different sides of it, by one expression of each end, so that pieces that share an end are counted consistently, and
// the two lie on different sides of a–b.
#if defined(LINES) || defined(ARCS) || defined(FLAT_ARCS)
float cross_segment(inout Region at, vec2 here, vec2 a, vec2 b) {
  float side = cross2(b - a, here - a);
  bool between = (cross2(here, a) > 0.0) != (cross2(here, b) > 0.0);
  at.inside = at.inside != (between && (side > 0.0) != (cross2(a, b) > 0.0));
  return side;
}
#endif

#if defined(LINES) || defined(FLAT_ARCS)
void test_line(inout Region at, vec2 here, vec4 l, bool feature) {
  float side = cross_segment(at, here, l.xy, l.zw);
  vec2 ab = l.zw - l.xy, size = abs(ab);
  at.near = at.near || (abs(side) < at.rounding * max(size.x, size.y) && dot(here - l.xy, here - l.zw) <= 0.0);
#ifdef EDGES
  if (feature) meet_segment(at, side, here - l.xy, ab);
#endif
}
#endif

#if defined(ARCS) || defined(FLAT_ARCS)
// The triangle p0 p1 p2 is counter-clockwise. In barycentric coordinates, here times its area, a point is in the bulge if
// 0 <= b1² < 4 w² b0 b2; b1 is told by the chord's side, by the same expression.
void test_arc(inout Region at, vec2 here, vec4 a01, vec4 a2w, bool feature) {
  vec2 p0 = a01.xy, p1 = a01.zw, p2 = a2w.xy;
  float side = cross_segment(at, here, p0, p2);
  vec2 e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0, d = here - p1;
  float b0 = cross2(e0, d), b2 = cross2(e2, d), sharp = a2w.z;
  float g = sharp * b0 * b2 - side * side;
  bool bulge = min(b0, b2) >= 0.0 && !(side > 0.0);
  at.inside = at.inside != (bulge && g > 0.0);
  vec2 turned = sharp * (e0 * b2 + e2 * b0) + 2.0 * side * e1, gradient = vec2(-turned.y, turned.x);
  at.near = at.near || (bulge && g * g < at.rounding * at.rounding * dot(gradient, gradient));
#ifdef EDGES
  if (feature) meet_arc(at, here, p0, e1, side, cross2(e0, e1), min(b0, b2), sharp, g, gradient);
#endif
}
#endif

#ifdef ELLIPSES
void test_ellipse(inout Region at, vec2 here, vec4 e, float myy, bool feature) {
  vec2 d = here - e.xy, q = vec2(e.z * d.x + e.w * d.y, e.w * d.x + myy * d.y);
  float g = 1.0 - dot(q, q);
  vec2 gradient = -2.0 * vec2(e.z * q.x + e.w * q.y, e.w * q.x + myy * q.y);
  at.inside = at.inside != (g > 0.0);
  at.near = at.near || g * g <= at.rounding * at.rounding * dot(gradient, gradient);
#ifdef EDGES
  if (feature) meet_edge(at, g, vec3(gradient, 0.0));
#endif
}
#endif

#ifdef FLAT_ARCS
flat in vec2 reference;
flat in uvec2 flat_counts;  // 1 if the reference is inside, feature lines | feature arcs << 8
#if FLAT_LINES
flat in vec4 lines[FLAT_LINES];
#endif
#if FLAT_ARCS
flat in vec4 arcs[2 * FLAT_ARCS];
#endif
void test_pieces(inout Region at, int texel, uint meta) {
  vec2 here = at.p.xy - reference;
  at.inside = flat_counts.x != 0u;
#if FLAT_LINES
  int feature_lines = int(flat_counts.y & 255u);
  for (int i = 0; i < FLAT_LINES; ++i) test_line(at, here, lines[i], i < feature_lines);
#endif
#if FLAT_ARCS
  int feature_arcs = int(flat_counts.y >> 8);
  for (int i = 0; i < FLAT_ARCS; ++i) test_arc(at, here, arcs[2 * i], arcs[2 * i + 1], i < feature_arcs);
#endif
  at.inside = at.inside || at.near;
}
#elif defined(PIECES)
void test_pieces(inout Region at, int texel, uint meta) {
  uvec4 head = texelFetch(heap, texel);
  int planes = int((meta >> 16) & 255u);
  ++texel;
  at.inside = (meta & kReferenceInside) != 0u;
  vec2 here = at.p.xy - uintBitsToFloat(head.zw);
  int next = texel + planes;
#ifdef LINES
  int lines = int(head.x & 4095u), feature_lines = int(head.y & 4095u);
  for (int i = 0; i < lines; ++i) test_line(at, here, heap_texel(next + i), i < feature_lines);
  next += lines;
#endif
#ifdef ARCS
  int arcs = int((head.x >> 12) & 4095u), feature_arcs = int((head.y >> 12) & 4095u);
  for (int i = 0; i < arcs; ++i) test_arc(at, here, heap_texel(next + 2 * i), heap_texel(next + 2 * i + 1), i < feature_arcs);
  next += 2 * arcs;
#endif
#ifdef ELLIPSES
  int ellipses = int(head.x >> 24), feature_ellipses = int(head.y >> 24);
  for (int i = 0; i < ellipses; ++i)
    test_ellipse(at, here, heap_texel(next + 2 * i), heap_texel(next + 2 * i + 1).x, i < feature_ellipses);
#endif
  at.inside = at.inside || at.near;
#ifdef PLANES
  test_planes(at, texel, planes, int(meta >> 24));
#endif
}
#endif

#if defined(EDGES) && !defined(PIECES)
// The features in and near a tile, points relative to the DP's origin: see tiles.h.
uniform usamplerBuffer tiles;
uniform int first_edge;

void meet_edges(inout Region at, uvec4 run) {
  int next = first_edge + int(run.x);
  vec2 here = at.p.xy;
  for (int i = 0; i < int(run.y); ++i) {
    vec4 l = uintBitsToFloat(texelFetch(tiles, next + i));
    vec2 ab = l.zw - l.xy;
    meet_segment(at, cross2(ab, here - l.xy), here - l.xy, ab);
  }
  next += int(run.y);
  for (int i = 0; i < int(run.z); ++i) {
    vec4 a01 = uintBitsToFloat(texelFetch(tiles, next + 2 * i)), a2w = uintBitsToFloat(texelFetch(tiles, next + 2 * i + 1));
    vec2 p0 = a01.xy, e0 = a2w.xy - a01.zw, e1 = p0 - a2w.xy, e2 = a01.zw - p0, d = here - a01.zw;
    float b0 = cross2(e0, d), b2 = cross2(e2, d), side = cross2(here - p0, e1);
    vec2 turned = a2w.z * (e0 * b2 + e2 * b0) + 2.0 * side * e1;
    meet_arc(at, here, p0, e1, side, cross2(e0, e1), min(b0, b2), a2w.z, a2w.z * b0 * b2 - side * side, vec2(-turned.y, turned.x));
  }
  next += 2 * int(run.z);
  for (int i = 0; i < int(run.w); ++i) {
    vec4 e = uintBitsToFloat(texelFetch(tiles, next + 2 * i));
    float myy = uintBitsToFloat(texelFetch(tiles, next + 2 * i + 1).x);
    vec2 from = here - e.xy, q = vec2(e.z * from.x + e.w * from.y, e.w * from.x + myy * from.y);
    meet_edge(at, 1.0 - dot(q, q), vec3(-2.0 * (e.z * q.x + e.w * q.y), -2.0 * (e.w * q.x + myy * q.y), 0.0));
  }
}
#endif

#ifdef EDGES
uniform float edge_half_width;
flat in float ink;  // less than 1 on what is so small that its edges would blacken it

// How much of the pixel an edge covers, as exactly as the bits of the id picture hold it; and those.
float edge_cover(float distance_px) {
  return floor(ink * clamp(edge_half_width + 0.5 - distance_px, 0.0, 1.0) * kEdgeLevels + 0.5) / kEdgeLevels;
}
uint edge_bits(float cover) { return uint(cover * kEdgeLevels + 0.5) << kEdgeShift; }
#endif
