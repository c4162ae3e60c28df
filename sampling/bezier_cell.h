// A quadric DP for a piece of a Bézier patch, and the proof of how far it is off.
#ifndef DUPIN_SAMPLING_BEZIER_CELL_H
#define DUPIN_SAMPLING_BEZIER_CELL_H

#include <array>

#include "../nurbs/bezier.h"
#include "bernstein.h"
#include "cell_model.h"
#include "quadric_dp.h"

namespace dupin {

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
  bool valid = false;  ///< the cell is a graph over the DP's tangent plane and the quadric one sheet above
                       ///< it; the rest holds
  int pieces_u = 1, pieces_v = 1;  ///< if the cell has to be split: into how many, one of them above 1
  double excess = 0;               ///< what asks for the split, over what is allowed; 0: not known
  bool quadric_decides = false;    ///< it is one graph, only not close enough to the quadric
  double bound = 0;                ///< largest distance between quadric and surface, along the DP's normal
  double normal_bound = 0;
  QuadricDp dp;         ///< frame, quadric, z-range
  CellMargins margins;  ///< as asked for, 0 at collapsed sides
  /// Largest |∇s|, |∇t| in the DP's (x,y), of the cell's own parameters; 0 where a side is collapsed.
  double gradient_s = 0, gradient_t = 0;
  double overrun[4] = {0, 0, 0, 0};        ///< how far the footprint reaches over the cell's sides
  double margin_needed[4] = {0, 0, 0, 0};  ///< for whoever makes the footprint: what its sides would take
  double overshoot = 0;  ///< likewise: how far it reaches over the grown cell, at a collapsed side
  /// The grown cell's poles along its border, in the DP's (x,y): sides v = 0, u = 1, v = 1, u = 0; the cell's
  /// own likewise. The grown border may be off by `border_slack`.
  BorderPoles border[4], grown_border[4];
  double border_slack = 0;
};

/// What a cell's DP is to meet.
struct CellRequest {
  double tolerance = 0, normal_tolerance = 0;
  CellMargins margins;
  /// What the surface may differ by from the patch carried on into its margins: across knots, over the grown
  /// cell.
  Remainder beyond;
};

/// Fits and certifies in one go, reusing its buffers from cell to cell.
class CellFitter {
 public:
  /// Stops early, with valid = false, once a bound is known to exceed the tolerances.
  CellFit fit(const BezierPatch& cell, const CellRequest& request);

 private:
  bool place(const BezierPatch& cell, CellFit& out);
  void load(const BezierPatch& grown, const QuadricDp& dp);
  void fit_third_order(double tolerance, QuadricDp& dp);
  bool set_up_normals(const CollapsedSides& collapsed, const CellMargins& margins);
  bool certify(const CellRequest& request, CellFit& out);
  bool certify_normals(const CellRequest& request, double gz, CellFit& out);
  double turned_beyond(const Remainder& beyond, double twisted) const;
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

/// Equal pieces by de Casteljau, along_u × along_v of them, v running faster.
std::vector<BezierPatch> split_patch(const BezierPatch& patch, int along_u, int along_v);
BezierPatch grown_patch(const BezierPatch& patch, const CellMargins& margins);
/// Box of the dehomogenised poles.
Box3 poles_box(const BezierPatch& patch);

}  // namespace dupin

#endif
