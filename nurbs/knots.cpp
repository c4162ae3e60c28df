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

void basis_derivatives(std::span<const double> knots, int degree, int span, double t, int order, double* out) {
  // ndu holds the basis functions of every degree (upper triangle) and the knot differences (lower triangle):
  // Piegl & Tiller, The NURBS Book, algorithm A2.3.
  const int p = degree;
  std::array<std::array<double, kMaxDegree + 1>, kMaxDegree + 1> ndu;
  std::array<double, kMaxDegree + 1> left{}, right{};
  ndu[0][0] = 1;
  for (int j = 1; j <= p; ++j) {
    left[j] = t - knots[span + 1 - j];
    right[j] = knots[span + j] - t;
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      ndu[j][r] = right[r + 1] + left[j - r];
      const double term = ndu[j][r] != 0 ? ndu[r][j - 1] / ndu[j][r] : 0;
      ndu[r][j] = saved + right[r + 1] * term;
      saved = left[j - r] * term;
    }
    ndu[j][j] = saved;
  }
  for (int j = 0; j <= p; ++j) out[j] = ndu[j][p];
  for (int k = 1; k <= order; ++k)
    if (k > p)
      for (int j = 0; j <= p; ++j) out[k * (p + 1) + j] = 0;
  const int top = std::min(order, p);
  for (int r = 0; r <= p; ++r) {
    std::array<std::array<double, kMaxDegree + 1>, 2> a{};
    int s1 = 0, s2 = 1;
    a[0][0] = 1;
    for (int k = 1; k <= top; ++k) {
      double d = 0;
      const int rk = r - k, pk = p - k;
      if (r >= k) {
        a[s2][0] = ndu[pk + 1][rk] != 0 ? a[s1][0] / ndu[pk + 1][rk] : 0;
        d = a[s2][0] * ndu[rk][pk];
      }
      const int j1 = rk >= -1 ? 1 : -rk, j2 = r - 1 <= pk ? k - 1 : p - r;
      for (int j = j1; j <= j2; ++j) {
        a[s2][j] = ndu[pk + 1][rk + j] != 0 ? (a[s1][j] - a[s1][j - 1]) / ndu[pk + 1][rk + j] : 0;
        d += a[s2][j] * ndu[rk + j][pk];
      }
      if (r <= pk) {
        a[s2][k] = ndu[pk + 1][r] != 0 ? -a[s1][k - 1] / ndu[pk + 1][r] : 0;
        d += a[s2][k] * ndu[r][pk];
      }
      out[k * (p + 1) + r] = d;
      std::swap(s1, s2);
    }
  }
  double factor = p;
  for (int k = 1; k <= top; ++k) {
    for (int j = 0; j <= p; ++j) out[k * (p + 1) + j] *= factor;
    factor *= p - k;
  }
}

}  // namespace dupin
