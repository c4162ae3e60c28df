// The region of a quadric DP, tested as the shader tests it.
#include "quadric_dp.h"

namespace dupin {
namespace {

/// Whether the segment from the reference r to p crosses the segment a–b; each end point's side is decided by one
/// expression of that point alone, so chains that share end points are counted consistently.
bool crosses(Vec2 r, Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = p - r;
  const bool side_a = cross(d, a - r) > 0, side_b = cross(d, b - r) > 0;
  if (side_a == side_b) return false;
  return (cross(b - a, p - a) > 0) != (cross(b - a, r - a) > 0);
}

/// Between chord and arc: barycentric coordinates (b0, b1, b2) with 0 <= b1² <= 4 w² b0 b2.
bool in_bulge(const ArcPiece& arc, Vec2 p) {
  const double area = cross(arc.p1 - arc.p0, arc.p2 - arc.p0);
  if (area == 0) return false;
  const double b0 = cross(arc.p1 - p, arc.p2 - p) / area, b2 = cross(arc.p0 - p, arc.p1 - p) / area;
  const double b1 = 1 - b0 - b2;
  return b0 >= 0 && b1 > 0 && b1 * b1 < 4 * arc.w * arc.w * b0 * b2;
}

bool in_ellipse(const EllipsePiece& e, Vec2 p) {
  const Vec2 d = p - e.center;
  const double x = e.mxx * d.x + e.mxy * d.y, y = e.mxy * d.x + e.myy * d.y;
  return x * x + y * y < 1;
}

}  // namespace

bool pieces_contain(const PartDps& part, const QuadricDp& dp, Vec2 p) {
  // Bulges and ellipses hold the reference or not once and for all: `reference_inside` has that folded in.
  bool inside = dp.reference_inside;
  for (std::uint32_t i = 0; i < dp.lines; ++i) {
    const LinePiece& piece = part.lines[dp.first_line + i];
    inside ^= crosses(dp.reference, p, piece.p0, piece.p1);
  }
  for (std::uint32_t i = 0; i < dp.arcs; ++i) {
    const ArcPiece& piece = part.arcs[dp.first_arc + i];
    inside ^= crosses(dp.reference, p, piece.p0, piece.p2);
    inside ^= in_bulge(piece, p);
  }
  for (std::uint32_t i = 0; i < dp.ellipses; ++i) inside ^= in_ellipse(part.ellipses[dp.first_ellipse + i], p);
  return inside;
}

bool region_contains(const PartDps& part, const QuadricDp& dp, const Vec3& p) {
  if (p.z < dp.z_lo || p.z > dp.z_hi) return false;
  const Vec2 q{p.x, p.y};
  for (int i = 0; i < 4; ++i) {
    const Vec2 from = dp.footprint[i], to = dp.footprint[(i + 1) % 4];
    if (cross(to - from, q - from) < 0) return false;
  }
  for (std::uint32_t i = 0; i < dp.planes; ++i) {
    const ClipPlane& plane = part.planes[dp.first_plane + i];
    if (dot(plane.n, p) + plane.d < 0) return false;
  }
  return pieces_contain(part, dp, q);
}

std::size_t DpScene::count() const {
  std::size_t n = 0;
  for (const PartDps& part : parts) n += part.dps.size();
  return n;
}

}  // namespace dupin
