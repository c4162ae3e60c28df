// The region of a quadric DP, tested as the shader tests it.
#include "quadric_dp.h"

#include <algorithm>
#include <utility>

#include "piece_tests.h"

namespace dupin {

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
  for (std::uint32_t i = 0; i < dp.ellipses; ++i)
    inside ^= in_ellipse(part.ellipses[dp.first_ellipse + i], p);
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

void append(const PartDps& from, PartDps& to) {
  const auto planes = static_cast<std::uint32_t>(to.planes.size()),
             lines = static_cast<std::uint32_t>(to.lines.size());
  const auto arcs = static_cast<std::uint32_t>(to.arcs.size()),
             ellipses = static_cast<std::uint32_t>(to.ellipses.size());
  for (QuadricDp dp : from.dps) {
    dp.first_plane += planes, dp.first_line += lines, dp.first_arc += arcs, dp.first_ellipse += ellipses;
    to.dps.push_back(dp);
  }
  to.bound_px = std::max(to.bound_px, from.bound_px);
  to.planes.insert(to.planes.end(), from.planes.begin(), from.planes.end());
  to.lines.insert(to.lines.end(), from.lines.begin(), from.lines.end());
  to.arcs.insert(to.arcs.end(), from.arcs.begin(), from.arcs.end());
  to.ellipses.insert(to.ellipses.end(), from.ellipses.begin(), from.ellipses.end());
  to.skipped.insert(to.skipped.end(), from.skipped.begin(), from.skipped.end());
}

void append(PartDps&& from, PartDps& to) {
  const bool nothing = to.dps.empty() && to.planes.empty() && to.lines.empty() && to.arcs.empty() &&
                       to.ellipses.empty() && to.skipped.empty() && to.out_of_picture.empty() &&
                       to.bound_px == 0;
  if (nothing)
    to = std::move(from);
  else
    append(std::as_const(from), to), from = {};
}

std::size_t DpScene::count() const {
  std::size_t n = 0;
  for (const PartDps& part : parts) n += part.dps.size();
  return n;
}

}  // namespace dupin
