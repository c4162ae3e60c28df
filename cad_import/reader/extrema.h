// The points of a curve at which its coordinates are largest and smallest.
#ifndef DUPIN_CAD_IMPORT_READER_EXTREMA_H
#define DUPIN_CAD_IMPORT_READER_EXTREMA_H

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../nurbs/curve.h"

namespace dupin::reader {

/// The largest value of a function with one maximum in [a, c], by golden section.
template <class F>
double largest_between(F&& f, double a, double c) {
  constexpr double kGolden = 0.6180339887498949;
  double x1 = c - kGolden * (c - a), x2 = a + kGolden * (c - a), f1 = f(x1), f2 = f(x2);
  // Near its top the value's error is the square of the argument's.
  const double enough = 1e-6 * (c - a);
  for (int i = 0; i < 40 && c - a > enough; ++i) {
    if (f1 > f2)
      c = x2, x2 = x1, f2 = f1, x1 = c - kGolden * (c - a), f1 = f(x1);
    else
      a = x1, x1 = x2, f1 = f2, x2 = a + kGolden * (c - a), f2 = f(x2);
  }
  return std::max(f1, f2);
}

/// Calls add(point) with points whose box contains the curve over [t0, t1] to within rounding: samples of
/// each smooth piece, and between them the extrema of each coordinate.
template <int kDimension, class V, class F>
void for_each_extremum(const CurveOf<V>& curve, double t0, double t1, F&& add) {
  if (std::holds_alternative<LineOf<V>>(curve.geometry)) {
    add(point_at(curve, t0));
    add(point_at(curve, t1));
    return;
  }
  const auto* spline = std::get_if<BsplineOf<V>>(&curve.geometry);
  const int samples = spline ? 4 * spline->degree : 16;
  std::vector<double> stops = breaks(curve, t0, t1, 3);
  stops.insert(stops.begin(), t0);
  stops.push_back(t1);
  std::vector<V> p(samples + 1);
  for (std::size_t piece = 0; piece + 1 < stops.size(); ++piece) {
    const auto at = [&](int i) { return stops[piece] + (stops[piece + 1] - stops[piece]) * i / samples; };
    for (int i = 0; i <= samples; ++i) add(p[i] = point_at(curve, at(i)));
    for (int i = 1; i < samples; ++i)
      for (int axis = 0; axis < kDimension; ++axis)
        for (const double sign : {1.0, -1.0}) {
          const double here = sign * p[i][axis];
          if (!(here > sign * p[i - 1][axis] && here >= sign * p[i + 1][axis])) continue;
          // Next to a top, samples differ by as much as it can rise above them.
          const double drop = here - std::min(sign * p[i - 1][axis], sign * p[i + 1][axis]);
          if (drop < 1e-13 * std::abs(here)) continue;
          V q = p[i];
          q[axis] = sign * largest_between([&](double t) { return sign * point_at(curve, t)[axis]; },
                                           at(i - 1), at(i + 1));
          add(q);
        }
  }
}

}  // namespace dupin::reader

#endif
