#include "dp_bounds.h"

#include "tiles.h"

namespace dupin {
namespace {

/// ∇F is affine in the point, so over the prism it stays in the convex hull of its values at the corners: a
/// convex cone that holds those holds them all.
void bound_normals(const QuadricDp& dp, const std::array<Vec3, 8>& box, DpBounds& bounds) {
  const double side = dp.flipped ? -1 : 1;
  std::array<Vec3, 8> normals;
  Vec3 sum;
  for (std::size_t i = 0; i < 8; ++i) {
    normals[i] = normalized(quadric_gradient(dp, box[i])) * side;
    sum += normals[i];
  }
  const Vec3 axis = normalized(sum);
  double smallest = 1;
  for (const Vec3& n : normals) smallest = std::min(smallest, dot(n, axis));
  bounds.axis = dp.u * axis.x + dp.v * axis.y + dp.n() * axis.z;
  if (smallest > 0) bounds.sin_cone = std::sqrt(std::max(0.0, 1 - smallest * smallest)) + 1e-6;
}

template <class Piece>
void take_features(const std::vector<Piece>& pieces, std::uint32_t first, std::uint32_t count,
                   std::vector<Piece>& out) {
  for (std::uint32_t i = first; i < first + count; ++i)
    if (pieces[i].feature) out.push_back(pieces[i]);
}

void find_features(const PartDps& part, const QuadricDp& dp, DpBounds& bounds) {
  FeatureEdges& edges = bounds.edges;
  for (std::size_t k = 0; k < 4; ++k)
    if (dp.feature_sides & 1U << k) edges.lines.push_back({dp.footprint[k], dp.footprint[(k + 1) % 4], true});
  take_features(part.lines, dp.first_line, dp.lines, edges.lines);
  take_features(part.arcs, dp.first_arc, dp.arcs, edges.arcs);
  take_features(part.ellipses, dp.first_ellipse, dp.ellipses, edges.ellipses);
  bounds.end_features = dp.feature_sides & 48;
  for (std::uint32_t i = 0; i < dp.planes; ++i)
    bounds.end_features |= part.planes[dp.first_plane + i].feature;
}

std::uint32_t flat_pieces(const QuadricDp& dp) {
  if (dp.planes > 0 || dp.ellipses > 0) return 0;
  for (std::uint32_t k = 0; k < std::size(kFlatPieces); ++k)
    if (dp.lines <= kFlatPieces[k].lines && dp.arcs <= kFlatPieces[k].arcs) return k + 1;
  return 0;
}

}  // namespace

std::array<Vec3, 8> prism_corners(const QuadricDp& dp) {
  std::array<Vec3, 8> result;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec2 p = dp.footprint[i % 4];
    result[i] = {p.x, p.y, dp.planar ? 0.0 : i < 4 ? dp.z_lo : dp.z_hi};
  }
  return result;
}

DpBounds dp_bounds(const PartDps& part, const QuadricDp& dp, const Vec3& anchor) {
  const std::array<Vec3, 8> box = prism_corners(dp);
  DpBounds bounds;
  bounds.dp = dp;
  bounds.origin = dp.origin - anchor;
  Box3 local;
  for (const Vec3& c : box) local.add(c);
  const Vec3 center = local.center();
  for (const Vec3& c : box) bounds.radius = std::max(bounds.radius, length(c - center));
  bounds.center = bounds.origin + dp.u * center.x + dp.v * center.y + dp.n() * center.z;
  if (dp.planar) {
    bounds.axis = dp.flipped ? -dp.n() : dp.n();
    bounds.sin_cone = 0;
  } else {
    bound_normals(dp, box, bounds);
  }
  bounds.pieces = dp.lines + dp.arcs + dp.ellipses > 0 || !dp.reference_inside;
  if (bounds.pieces) {
    bounds.cells = region_cells(part, dp);
    bounds.flat = flat_pieces(dp);
  }
  find_features(part, dp, bounds);
  return bounds;
}

}  // namespace dupin
