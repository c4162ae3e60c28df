// Inside the folder: truncated Taylor series in one and two variables, for offsets.
//
// A series holds a_ij = ∂ⁱ⁺ʲf / (i! j!); products are convolutions, and a power f^a follows from f·∂(f^a) =
// a·f^a·∂f.
#ifndef DUPIN_NURBS_TAYLOR_H
#define DUPIN_NURBS_TAYLOR_H

#include "jets.h"

namespace dupin {

/// Divides (or multiplies back) a triangle of derivatives by i! j!.
inline void to_series(int order, Vec3* d) {
  for (int n = 0; n <= order; ++n)
    for (int j = 0; j <= n; ++j) d[jet_index(n - j, j)] *= 1 / (kFactorial[n - j] * kFactorial[j]);
}
inline void to_derivatives(int order, Vec3* d) {
  for (int n = 0; n <= order; ++n)
    for (int j = 0; j <= n; ++j) d[jet_index(n - j, j)] *= kFactorial[n - j] * kFactorial[j];
}

/// out = product(a, b) of two series, for any bilinear product.
template <class A, class B, class C, class Product>
void multiply_series(int order, const A* a, const B* b, C* out, Product product) {
  for (int n = 0; n <= order; ++n)
    for (int j = 0; j <= n; ++j) {
      const int i = n - j;
      C sum{};
      for (int k = 0; k <= i; ++k)
        for (int l = 0; l <= j; ++l) sum = sum + product(a[jet_index(k, l)], b[jet_index(i - k, j - l)]);
      out[jet_index(i, j)] = sum;
    }
}

/// f = q^a for a series q with q(0) > 0.
inline void power_series(int order, const double* q, double a, double* f) {
  f[0] = std::pow(q[0], a);
  for (int n = 1; n <= order; ++n)
    for (int j = 0; j <= n; ++j) {
      const int i = n - j;
      const bool by_u = i > 0;
      double sum = 0;
      for (int k = 0; k <= i; ++k)
        for (int l = 0; l <= j; ++l) {
          if (k + l == 0) continue;
          const double factor = by_u ? a * k - (i - k) : a * l - (j - l);
          sum += factor * q[jet_index(k, l)] * f[jet_index(i - k, j - l)];
        }
      f[jet_index(i, j)] = sum / ((by_u ? i : j) * q[0]);
    }
}

/// The unit vector n/|n| of a vector-valued series, as a series.
inline void normalize_series(int order, const Vec3* n, Vec3* unit) {
  double square[jet_size(kMaxOrder)] = {}, inverse_length[jet_size(kMaxOrder)] = {};
  multiply_series(order, n, n, square, [](const Vec3& a, const Vec3& b) { return dot(a, b); });
  power_series(order, square, -0.5, inverse_length);
  multiply_series(order, n, inverse_length, unit, [](const Vec3& a, double b) { return a * b; });
}

}  // namespace dupin

#endif
