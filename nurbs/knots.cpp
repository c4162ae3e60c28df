#include "knots.h"

#include <algorithm>
#include <array>

namespace dupin {

int find_span(std::span<const double> knots, int degree, double t, bool from_left) {
  const int n = static_cast<int>(knots.size()) - degree - 1;
  const auto begin = knots.begin() + degree, end = knots.begin() + n + 1;
  const auto it = from_left ? std::lower_bound(begin, end, t) : std::upper_bound(begin, end, t);
  int span = static_cast<int>(it - knots.begin()) - 1;
  span = std::clamp(span, degree, n - 1);
  while (span > degree && knots[span] == knots[span + 1]) --span;
  while (span < n - 1 && knots[span] == knots[span + 1]) ++span;
  return span;
}

namespace {

// Level q of the triangle turns the q functions of degree q − 1 into the q + 1 of degree q; both the values
// and the derivatives need the reciprocals of the same knot differences, kept in `inverse`, level after
// level. The m-th derivatives of degree q come from the (m−1)-th of degree q − 1 by
//   N'[r] = q (N[r−1] / (k[s+r] − k[s+r−q]) − N[r] / (k[s+r+1] − k[s+r+1−q])).
// A degree known at compile time unrolls everything.
template <int kDegree>
void basis_of_degree(const double* knots, int degree, int span, double t, int order, double* out) {
  const int p = kDegree > 0 ? kDegree : degree;
  constexpr int kSize = (kDegree > 0 ? kDegree : kMaxDegree) + 1;
  double inverse[kSize * (kSize - 1) / 2 + 1];
  double values[kSize][kSize];  // values[q][0 … q], of degree q
  values[0][0] = 1;
  for (int q = 1, base = 0; q <= p; base += q, ++q) {
    double saved = 0;
    for (int r = 0; r < q; ++r) {
      const double lo = knots[span + 1 - q + r], hi = knots[span + 1 + r];
      const double reciprocal = hi > lo ? 1 / (hi - lo) : 0;
      inverse[base + r] = reciprocal;
      const double term = values[q - 1][r] * reciprocal;
      values[q][r] = saved + (hi - t) * term;
      saved = (t - lo) * term;
    }
    values[q][q] = saved;
  }
  for (int j = 0; j <= p; ++j) out[j] = values[p][j];
  for (int k = 1; k <= order; ++k) {
    double* d = out + k * (p + 1);
    if (k > p) {
      for (int j = 0; j <= p; ++j) d[j] = 0;
      continue;
    }
    for (int j = 0; j <= p - k; ++j) d[j] = values[p - k][j];
    for (int q = p - k + 1; q <= p; ++q) {
      const double* reciprocals = inverse + q * (q - 1) / 2;
      double before = 0;
      for (int r = 0; r < q; ++r) {
        const double term = q * d[r] * reciprocals[r];
        d[r] = before - term;
        before = term;
      }
      d[q] = before;
    }
  }
}

}  // namespace

void basis_derivatives(std::span<const double> knots, int degree, int span, double t, int order,
                       double* out) {
  switch (degree) {
    case 1:
      return basis_of_degree<1>(knots.data(), degree, span, t, order, out);
    case 2:
      return basis_of_degree<2>(knots.data(), degree, span, t, order, out);
    case 3:
      return basis_of_degree<3>(knots.data(), degree, span, t, order, out);
    case 5:
      return basis_of_degree<5>(knots.data(), degree, span, t, order, out);
    default:
      return basis_of_degree<0>(knots.data(), degree, span, t, order, out);
  }
}

}  // namespace dupin
