// Which points of the parameter plane a face's loops enclose, decided on the pcurves themselves.
//
// Every pcurve is cut where its v turns back, so that each piece crosses a line of constant v at most once.
// A point is inside if a ray from it towards growing u crosses an odd number of pieces; where the piece's
// box does not decide, its parameter at that v is found in a bracket and its u compared. Consecutive pieces
// share their end points as the same numbers (gaps between trims are bridged by straight segments), so that
// no ray slips through a joint, whatever the rounding.
#ifndef DUPIN_EXACT_TRIM_REGION_H
#define DUPIN_EXACT_TRIM_REGION_H

#include <vector>

#include "../nurbs/model.h"

namespace dupin::exact {

class TrimRegion {
 public:
  /// `face` must outlive it. Periods of 0: the parameters do not repeat.
  TrimRegion(const Part& part, const Face& face);

  /// Whether (u,v), or the same point whole periods away, lies inside; if so it is moved there.
  bool contains(Vec2& uv) const;
  /// The widest gap that was bridged, in parameters.
  double widest_gap() const { return widest_gap_; }

 private:
  /// Monotone in v; `curve` is null for a straight bridge.
  struct Piece {
    const Curve2* curve = nullptr;
    double t0 = 0, t1 = 0;
    Vec2 p0, p1;
    double least_u = 0, most_u = 0;  ///< contain it; exact for straight pieces
  };
  void add_loop(const Part& part, const Loop& loop);
  void add_trim(const Trim& trim, double t0, double t1);
  void add_bridge(Vec2 from, Vec2 to);
  void sort_into_rows();
  bool inside(Vec2 uv) const;
  bool crosses(const Piece& piece, Vec2 uv) const;

  std::vector<Piece> pieces_;
  std::vector<std::vector<std::uint32_t>> rows_;  ///< of equal height over the box: the pieces that meet each
  Box2 box_;
  double period_u_ = 0, period_v_ = 0, widest_gap_ = 0;
  bool untrimmed_ = false;
};

/// The parameters inside (t0, t1) at which the curve's v turns back, ascending. Offset curves are searched
/// by samples, all other kinds in closed form or by isolating the roots of the derivative.
std::vector<double> turns_in_v(const Curve2& curve, double t0, double t1);

}  // namespace dupin::exact

#endif
