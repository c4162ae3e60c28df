// Spline surfaces in 100-digit arithmetic: what the stability report holds the evaluators against.
#ifndef DUPIN_BENCH_STABILITY_HUNDRED_DIGITS_H
#define DUPIN_BENCH_STABILITY_HUNDRED_DIGITS_H

#include "../../nurbs/surface.h"

namespace dupin::bench {

/// Principal curvatures by the fundamental forms, H ± sqrt(H² − K), from Cox and de Boor's basis.
struct ExactCurvature {
  Vec3 n, d1;  ///< d1 up to its sign
  double k1 = 0, k2 = 0;
  /// By how much a relative error of the derivatives is multiplied in the larger curvature: |Suu|/a² +
  /// |Suv|/(ad) + |Svv|/d², divided by |k1|, with the lengths a, d of Su and of the part of Sv across it.
  double condition = 0;
  bool regular = false;  ///< Su × Sv is not zero
};
/// Not at a knot.
ExactCurvature exact_curvature(const BsplineSurface& surface, double u, double v);

}  // namespace dupin::bench

#endif
