#include "tensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "homogeneous.h"

namespace dupin {

std::span<const double> binomials(int n) {
  static const std::vector<std::vector<double>> kRows = [] {
    std::vector<std::vector<double>> rows(kMaxTensorDegree + 1);
    for (int m = 0; m <= kMaxTensorDegree; ++m) {
      rows[m].assign(static_cast<std::size_t>(m) + 1, 1.0);
      for (int k = 1; k < m; ++k) rows[m][k] = rows[m - 1][k - 1] + rows[m - 1][k];
    }
    return rows;
  }();
  return kRows[n];
}

Tensor operator*(const Tensor& a, const Tensor& b) {
  Tensor out(a.p + b.p, a.q + b.q);
  const int columns = b.q + 1;
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j) {
      const double factor = a.at(i, j);
      if (factor == 0) continue;
      for (int k = 0; k <= b.p; ++k) {
        double* to = &out.at(i + k, j);
        const double* from = &b.c[static_cast<std::size_t>(k * columns)];
        for (int l = 0; l < columns; ++l) to[l] += factor * from[l];
      }
    }
  return out;
}

Tensor operator*(const Tensor& a, double s) {
  Tensor out = a;
  for (double& c : out.c) c *= s;
  return out;
}

Tensor raised(const Tensor& a, int p, int q) {
  if (p == a.p && q == a.q) return a;
  Tensor one(p - a.p, q - a.q);
  const std::span<const double> bu = binomials(one.p), bv = binomials(one.q);
  for (int i = 0; i <= one.p; ++i)
    for (int j = 0; j <= one.q; ++j) one.at(i, j) = bu[i] * bv[j];
  return a * one;
}

namespace {

Tensor combined(const Tensor& a, const Tensor& b, double sign) {
  const int p = std::max(a.p, b.p), q = std::max(a.q, b.q);
  Tensor out = raised(a, p, q);
  const Tensor other = raised(b, p, q);
  for (std::size_t i = 0; i < out.c.size(); ++i) out.c[i] += sign * other.c[i];
  return out;
}

/// Calls visit(i, j, coefficient) for the unscaled coefficients.
template <class Visit>
void visit_coefficients(const Tensor& a, Visit visit) {
  const std::span<const double> bu = binomials(a.p), bv = binomials(a.q);
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j) visit(i, j, a.at(i, j) / (bu[i] * bv[j]));
}

}  // namespace

Tensor operator+(const Tensor& a, const Tensor& b) {
  return combined(a, b, 1);
}
Tensor operator-(const Tensor& a, const Tensor& b) {
  return combined(a, b, -1);
}

// Unscaled, the derivative's coefficients are p (b[i+1] − b[i]); p C(p−1, i) / C(p, i+1) = i + 1 and p C(p−1,
// i) / C(p, i) = p − i.
Tensor derivative_u(const Tensor& a) {
  if (a.p == 0) return Tensor(0, a.q);
  Tensor out(a.p - 1, a.q);
  for (int i = 0; i < a.p; ++i)
    for (int j = 0; j <= a.q; ++j) out.at(i, j) = (i + 1) * a.at(i + 1, j) - (a.p - i) * a.at(i, j);
  return out;
}
Tensor derivative_v(const Tensor& a) {
  if (a.q == 0) return Tensor(a.p, 0);
  Tensor out(a.p, a.q - 1);
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j < a.q; ++j) out.at(i, j) = (j + 1) * a.at(i, j + 1) - (a.q - j) * a.at(i, j);
  return out;
}

ParameterRange coefficient_range(const Tensor& a) {
  ParameterRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  visit_coefficients(a, [&range](int, int, double c) {
    range.lo = std::min(range.lo, c);
    range.hi = std::max(range.hi, c);
  });
  return range;
}

double largest_coefficient(const Tensor& a) {
  const ParameterRange range = coefficient_range(a);
  return std::max(std::abs(range.lo), std::abs(range.hi));
}

double largest_quotient(const Tensor& a, const Tensor& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.c.size(); ++i) {
    if (!(b.c[i] > 0) || !std::isfinite(a.c[i])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(a.c[i]) / b.c[i]);
  }
  return largest;
}

HomogeneousTensors homogeneous_tensors(const BezierPatch& patch, const Frame3& frame) {
  const int p = patch.degree_u, q = patch.degree_v;
  HomogeneousTensors t{{Tensor(p, q), Tensor(p, q), Tensor(p, q)}, Tensor(p, q)};
  const std::span<const double> bu = binomials(p), bv = binomials(q);
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const Vec4& pole = patch.pole(i, j);
      const Vec3 local = homogeneous::xyz(pole) - frame.origin * pole.w;
      const double scale = bu[i] * bv[j];
      t.x[0].at(i, j) = scale * dot(frame.x, local);
      t.x[1].at(i, j) = scale * dot(frame.y, local);
      t.x[2].at(i, j) = scale * dot(frame.z, local);
      t.w.at(i, j) = scale * pole.w;
    }
  return t;
}

namespace {

using Tensor3 = std::array<Tensor, 3>;

Tensor3 cross(const Tensor3& a, const Tensor3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

std::array<Tensor, 3> normal_tensors(const HomogeneousTensors& t, bool rational) {
  const Tensor3 xu = {derivative_u(t.x[0]), derivative_u(t.x[1]), derivative_u(t.x[2])};
  const Tensor3 xv = {derivative_v(t.x[0]), derivative_v(t.x[1]), derivative_v(t.x[2])};
  Tensor3 n = cross(xu, xv);
  if (!rational) return n;
  const Tensor3 a = cross(xu, t.x), b = cross(t.x, xv);
  const Tensor wu = derivative_u(t.w), wv = derivative_v(t.w);
  for (int i = 0; i < 3; ++i) n[i] = t.w * n[i] - wv * a[i] - wu * b[i];
  return n;
}

}  // namespace dupin
