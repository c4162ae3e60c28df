// The three tests a boundary piece makes of a point; the shader's are the same, in float.
#ifndef DUPIN_SAMPLING_PIECE_TESTS_H
#define DUPIN_SAMPLING_PIECE_TESTS_H

#include "quadric_dp.h"

namespace dupin {

/// Whether the segment from the reference r to p crosses the segment a–b; each end point's side is decided by
/// one expression of that point alone, so chains that share end points are counted consistently.
inline bool crosses(Vec2 r, Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = p - r;
  const bool side_a = cross(d, a - r) > 0, side_b = cross(d, b - r) > 0;
  if (side_a == side_b) return false;
  return (cross(b - a, p - a) > 0) != (cross(b - a, r - a) > 0);
}

/// Between chord and arc: barycentric coordinates (b0, b1, b2) with 0 <= b1² <= 4 w² b0 b2.
inline bool in_bulge(const ArcPiece& arc, Vec2 p) {
  const double area = cross(arc.p1 - arc.p0, arc.p2 - arc.p0);
  if (area == 0) return false;
  const double b0 = cross(arc.p1 - p, arc.p2 - p) / area, b2 = cross(arc.p0 - p, arc.p1 - p) / area;
  const double b1 = 1 - b0 - b2;
  return b0 >= 0 && b1 > 0 && b1 * b1 < 4 * arc.w * arc.w * b0 * b2;
}

inline bool in_ellipse(const EllipsePiece& e, Vec2 p) {
  const Vec2 d = p - e.center;
  const double x = e.mxx * d.x + e.mxy * d.y, y = e.mxy * d.x + e.myy * d.y;
  return x * x + y * y < 1;
}

}  // namespace dupin

#endif
