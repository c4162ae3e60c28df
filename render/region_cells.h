// A DP's region as convex cells of its (x, y): what a pixel has to be tested against is then four sides, and
// at most one conic, whatever the number of pieces that bound the region.
//
// Straight pieces become sides of trapezoids. An arc lies in the triangle of its poles: the triangle is a
// cell of its own, on either side of the arc, and the trapezoids end where it begins. A whole ellipse lies in
// a parallelogram likewise.
#ifndef DUPIN_RENDER_REGION_CELLS_H
#define DUPIN_RENDER_REGION_CELLS_H

#include <optional>
#include <vector>

#include "../sampling/quadric_dp.h"

namespace dupin {

/// f·(x, y, 1)
struct LinearForm {
  double x = 0, y = 0, one = 0;
  double at(Vec2 p) const { return x * p.x + y * p.y + one; }
};

/// Inside where sign·(a·b − c²) > 0.
struct ConicTest {
  LinearForm a, b, c;
  double sign = 1;
  double steepest = 0;  ///< the largest |∇(a·b − c²)| along the conic's part in question
};

struct RegionCell {
  std::array<Vec2, 4> corners;  ///< convex, counter-clockwise; a corner may be repeated
  std::optional<ConicTest> conic;
};

/// Beyond this many pieces nothing is made of them.
inline constexpr std::size_t kMostCellPieces = 600;

/// Cells that do not overlap and together are the footprint's part of the region, clip planes aside. Empty if
/// pieces run into one another so that none can be told: the region is what its pieces say, then.
std::vector<RegionCell> region_cells(const PartDps& part, const QuadricDp& dp);

/// In double, borders included.
bool cell_contains(const RegionCell& cell, Vec2 p);

}  // namespace dupin

#endif
