#include "symmetric_eigen3.h"

#include <algorithm>
#include <cmath>

namespace dupin::amg {
namespace {

constexpr int kMostSweeps = 12;  // they converge quadratically; six are never exceeded

/// Turns rows and columns p, q of `a` so that a[p][q] vanishes, and the columns of `v` with them.
void rotate(double (&a)[3][3], double (&v)[3][3], int p, int q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = std::abs(theta) > 1e150
                       ? 0.5 / theta
                       : (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  a[p][p] -= t * a[p][q];
  a[q][q] += t * a[p][q];
  a[p][q] = a[q][p] = 0;
  const double rp = a[r][p], rq = a[r][q];
  a[r][p] = a[p][r] = c * rp - s * rq;
  a[r][q] = a[q][r] = s * rp + c * rq;
  for (auto& row : v) {
    const double vp = row[p], vq = row[q];
    row[p] = c * vp - s * vq;
    row[q] = s * vp + c * vq;
  }
}

}  // namespace

Eigen3 eigen(const Symmetric3& m) {
  double a[3][3] = {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    if (a[0][1] == 0 && a[0][2] == 0 && a[1][2] == 0) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
    // What rounding leaves of the off-diagonal is nothing beside the diagonal.
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}})
      if (std::abs(a[p][q]) < 1e-18 * (std::abs(a[p][p]) + std::abs(a[q][q]))) a[p][q] = a[q][p] = 0;
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] > a[j][j]; });
  Eigen3 result;
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = order[k];
    result.values[k] = a[i][i];
    result.vectors[k] = normalized(Vec3{v[0][i], v[1][i], v[2][i]});
  }
  result.vectors[2] = cross(result.vectors[0], result.vectors[1]);
  return result;
}

}  // namespace dupin::amg
