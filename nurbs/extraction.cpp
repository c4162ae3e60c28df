#include "extraction.h"

#include <algorithm>
#include <cmath>

#include "knots.h"

namespace dupin {

std::vector<SplinePiece> spline_pieces(std::span<const double> knots, int degree, bool periodic, double t0,
                                       double t1) {
  const int n = static_cast<int>(knots.size()) - degree - 1;
  const double lo = knots[degree], hi = knots[n], length = hi - lo;
  if (!periodic) t0 = std::clamp(t0, lo, hi), t1 = std::clamp(t1, lo, hi);
  const double sliver = 1e-13 * std::max({std::abs(t0), std::abs(t1), length});
  std::vector<SplinePiece> pieces;
  if (!(t1 - t0 > sliver)) return pieces;
  const double first = periodic ? std::floor((t0 - lo) / length) : 0;
  const double last = periodic ? std::floor((t1 - lo) / length) : 0;
  for (double turn = first; turn <= last; ++turn) {
    const double shift = turn * length;
    for (int span = degree; span < n; ++span) {
      if (!(knots[span + 1] > knots[span])) continue;
      const double a = std::max(t0, knots[span] + shift), b = std::min(t1, knots[span + 1] + shift);
      if (b - a > sliver) pieces.push_back({a, b, shift, span});
    }
  }
  if (pieces.empty()) return pieces;
  pieces.front().t0 = t0;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) pieces[i].t1 = pieces[i + 1].t0;
  pieces.back().t1 = t1;
  return pieces;
}

// The k-th Bézier pole over [a, b] is the spline's polar form with k arguments b and the others a (Ramshaw);
// the recurrence of the basis functions, with another argument at each level, gives its weights.
void extraction_matrix(std::span<const double> knots, int degree, const SplinePiece& piece, double* matrix) {
  const double a = piece.t0 - piece.shift, b = piece.t1 - piece.shift;
  for (int k = 0; k <= degree; ++k) {
    double* row = matrix + k * (degree + 1);
    row[0] = 1;
    for (int q = 1; q <= degree; ++q) {
      const double t = q <= k ? b : a;
      double saved = 0;
      for (int r = 0; r < q; ++r) {
        const double lo = knots[piece.span + 1 - q + r], hi = knots[piece.span + 1 + r];
        const double term = row[r] / (hi - lo);
        row[r] = saved + (hi - t) * term;
        saved = (t - lo) * term;
      }
      row[q] = saved;
    }
  }
}

}  // namespace dupin
