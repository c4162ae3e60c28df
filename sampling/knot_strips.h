// Across a knot line: by how much a surface differs from a patch's own polynomial carried on into its
// neighbour.
//
// A cell's certificate holds for its own patch, margins included. Where a DP reaches over a knot line the
// surface is the neighbouring patch, and the difference D has an expansion in the distance σ over the side, Σ
// D_k(t) σ^k, that starts at the order the spline is not smooth in. The neighbour may be run through at
// another speed: the comparison is at σ' = ρ1 σ + ρ2 σ² of it, which takes up what is parametrisation alone.
#ifndef DUPIN_SAMPLING_KNOT_STRIPS_H
#define DUPIN_SAMPLING_KNOT_STRIPS_H

#include <array>
#include <vector>

#include "../nurbs/bezier.h"
#include "series.h"

namespace dupin {

/// Over one side of a patch; σ in the patch's own parameter, which runs over [0,1].
struct SideStrip {
  static constexpr int kOrders = 12;
  static constexpr double kMostSigma = 0.1;  ///< no bound beyond; the orders left out are rounding up to here
  bool smooth = true;                        ///< nothing to add: no neighbour, or the same analytic surface
  std::array<double, kOrders> value{},
      along{};  ///< max over t of |D_k|, |∂D_k/∂t|, before the division by weights
  /// Of a rational patch's weight and its neighbour's: the least on the side, the largest of each higher
  /// order, and of their derivatives along it.
  bool rational = false;
  std::array<double, 2> least_weight{1, 1};
  std::array<std::array<double, kOrders>, 2> weight{}, weight_along{};

  /// Bounds for all σ up to this: of |D|, and of its derivatives over (ds) and along (dt) the side. Infinite
  /// beyond kMostSigma.
  Remainder at(double sigma) const;
  /// |∂D/∂σ| on the side itself: not 0 where the surface has a crease (or changes its speed unevenly).
  double crease() const { return smooth ? 0 : value[1] / (least_weight[0] * least_weight[1]); }
};

/// The patches of one surface, in a grid. Sides are v = 0, u = 1, v = 1, u = 0.
class KnotStrips {
 public:
  /// `wrap_u`, `wrap_v`: the last patch's neighbour is the first.
  KnotStrips(std::vector<const BezierPatch*> patches, bool wrap_u, bool wrap_v);
  /// Index, or −1.
  int neighbour(std::size_t patch, int side) const;
  SideStrip strip(std::size_t patch, int side) const;
  const BezierPatch& patch(std::size_t index) const { return *patches_[index]; }

  int columns() const { return static_cast<int>(u_.size()); }
  int rows() const { return static_cast<int>(v_.size()); }
  /// Where a column (row) begins; that of the end one past the last. Beyond the ends only where the grid
  /// wraps.
  double column_start(int column) const { return start(u_, u_end_, column); }
  double row_start(int row) const { return start(v_, v_end_, row); }
  /// Of the patch in a column and row, beyond the ends where the grid wraps; −1 where there is none.
  int index(int column, int row) const;

 private:
  std::vector<const BezierPatch*> patches_;
  static double start(const std::vector<double>& starts, double end, int i);
  std::vector<double> u_, v_;  ///< where columns and rows begin
  double u_end_ = 0, v_end_ = 0;
  std::vector<int> grid_, place_;
  bool wrap_u_, wrap_v_;
};

}  // namespace dupin

#endif
