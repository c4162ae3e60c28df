// What choosing and drawing a DP needs on the CPU.
#ifndef DUPIN_RENDER_DP_BOUNDS_H
#define DUPIN_RENDER_DP_BOUNDS_H

#include <cstdint>
#include <vector>

#include "../sampling/quadric_dp.h"
#include "region_cells.h"

namespace dupin {

/// Those of a DP's bounds in (x, y) that are feature edges, sides of the footprint among the lines.
struct FeatureEdges {
  std::vector<LinePiece> lines;
  std::vector<ArcPiece> arcs;
  std::vector<EllipsePiece> ellipses;
  std::size_t count() const { return lines.size() + arcs.size() + ellipses.size(); }
};

/// In the part's space relative to its anchor.
struct DpBounds {
  QuadricDp dp;
  Vec3 origin;  ///< the DP's
  Vec3 center;
  double radius = 0;
  Vec3 axis;            ///< of the cone that holds every outward normal
  double sin_cone = 2;  ///< of its half-angle, which is less than a right angle; > 1: there is no such cone
  std::uint32_t record = 0;
  /// The footprint is not all of the region, clip planes aside.
  bool pieces = false;
  std::vector<RegionCell> cells;  ///< with pieces, where they can be told by cells
  std::uint32_t flat = 0;  ///< with pieces: 1 + index of the kFlatPieces that has room for them; 0: none
  FeatureEdges edges;
  bool end_features = false;  ///< an end of the prism, or a clip plane, is a feature edge
  bool features() const { return end_features || edges.count() > 0; }
};
DpBounds dp_bounds(const PartDps& part, const QuadricDp& dp, const Vec3& anchor);

/// Corners 0–3 at z lo, 4–7 at z hi, in the DP's frame.
std::array<Vec3, 8> prism_corners(const QuadricDp& dp);

}  // namespace dupin

#endif
