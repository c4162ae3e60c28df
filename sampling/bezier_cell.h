// A quadric DP for a piece of a Bézier patch, and the proof of how far it is off.
#ifndef DUPIN_SAMPLING_BEZIER_CELL_H
#define DUPIN_SAMPLING_BEZIER_CELL_H

#include <array>

#include "../nurbs/bezier.h"
#include "bernstein.h"
#include "quadric_dp.h"

namespace dupin {

/// A cell is a patch over its own [0,1]². Its certificate holds on the cell grown by a part of its width on
/// every side (not across a collapsed one): neighbouring DPs overlap there, so that no crack opens between
/// their sheets.
inline constexpr double kCellMargin = 0.04;
/// For the sides v = 0, u = 1, v = 1, u = 0.
struct CellMargins {
  double side[4] = {kCellMargin, kCellMargin, kCellMargin, kCellMargin};
};

/// Which sides of a patch are a single point.
struct CollapsedSides {
  bool u0 = false, u1 = false, v0 = false, v1 = false;
};
CollapsedSides collapsed_sides(const BezierPatch& patch);

/// Up to kMaxDegree + 1 points, without an allocation.
struct BorderPoles {
  int count = 0;
  std::array<Vec2, 26> points;
  void push_back(Vec2 p) { points[static_cast<std::size_t>(count++)] = p; }
  const Vec2* begin() const { return points.data(); }
  const Vec2* end() const { return points.data() + count; }
  Vec2 front() const { return points[0]; }
  Vec2 back() const { return points[static_cast<std::size_t>(count - 1)]; }
};

/// What could be proved about a cell's DP.
struct CellFit {
  bool valid = false;   ///< the cell is a graph over the DP's tangent plane and the quadric one sheet above
                        ///< it; the rest holds
  bool split_u = true;  ///< if the cell has to be split: along u or along v
  bool quadric_decides = false;  ///< it is one graph, only not close enough to the quadric
  double bound = 0;              ///< largest distance between quadric and surface, along the DP's normal
  double normal_bound = 0;
  QuadricDp dp;                            ///< frame, quadric, z-range
  CellMargins margins;                     ///< as asked for, 0 at collapsed sides
  double margin_needed[4] = {0, 0, 0, 0};  ///< for whoever makes the footprint: what its sides would take
  /// The grown cell's poles along its border, in the DP's (x,y): sides v = 0, u = 1, v = 1, u = 0; the cell's
  /// own likewise.
  BorderPoles border[4], grown_border[4];
};

/// Fits and certifies in one go, reusing its buffers from cell to cell.
class CellFitter {
 public:
  /// Stops early, with valid = false, once a bound is known to exceed the tolerances.
  CellFit fit(const BezierPatch& cell, double tolerance, double normal_tolerance,
              const CellMargins& margins = {});

 private:
  bool place(const BezierPatch& cell, CellFit& out);
  void load(const BezierPatch& grown, const QuadricDp& dp);
  void fit_third_order(double tolerance, QuadricDp& dp);
  bool set_up_normals(const CollapsedSides& collapsed, const CellMargins& margins);
  bool certify(double tolerance, double normal_tolerance, CellFit& out);
  bool certify_normals(double normal_tolerance, double gz, CellFit& out);
  void fit_cubic(QuadricDp& dp);
  double twist();
  double gradient_bound(const bernstein::Net& net, int power);
  bernstein::Range derivative_range(const bernstein::Net& numerator, bool along_u, int power);

  bernstein::Net x_, y_, z_, w_;     // local homogeneous coordinates
  bernstein::Net f_, xz_, yz_, zz_;  // F's numerator and its parts
  bernstein::Net xx_, xy_, yy_, cubic_[4], cubic_rest_;
  bernstein::Net w_power_[2], d_, dw_, shifted_, tmp_;
  double least_w_ = 1, most_w_ = 1;
  bool rational_ = false;
  Box3 box_;  // of the grown cell, local
  double jacobian_[2][2] = {},
         inverse_[2][2] = {};  // ∂(x,y)/∂(s,t) at the centre; inverse in the grown cell's parameters
  const bernstein::Side *divide_u_ = nullptr, *divide_v_ = nullptr;  // what ∂/∂u, ∂/∂v are divided by
};

/// Sub-cells by de Casteljau at one half.
void split_patch(const BezierPatch& patch, bool along_u, BezierPatch& first, BezierPatch& second);
BezierPatch grown_patch(const BezierPatch& patch, const CellMargins& margins);
/// Box of the dehomogenised poles.
Box3 poles_box(const BezierPatch& patch);

}  // namespace dupin

#endif
