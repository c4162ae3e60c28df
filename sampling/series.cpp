#include "series.h"

#include <cmath>

namespace dupin {
namespace {

constexpr int kN = Series::kRows, kRow = Series::kRow;

/// rows[i1 + i2][j1 + k] += a[i1][j1] b[i2][k]; one operation an element, so that every clone gives the same
/// bits.
__attribute__((target_clones("avx2", "default"))) void convolve(const double (*a)[kRow],
                                                                const double (*b)[kRow],
                                                                double (*rows)[2 * kRow]) {
  for (int i1 = 0; i1 < kN; ++i1)
    for (int j1 = 0; j1 < kN - i1; ++j1) {
      const double s = a[i1][j1];
      if (s == 0) continue;
      for (int i2 = 0; i2 < kN - i1 - j1; ++i2) {
        double* to = rows[i1 + i2] + j1;
        const double* from = b[i2];
        for (int k = 0; k < kRow; ++k) to[k] += s * from[k];
      }
    }
}

/// One variable's powers to Chebyshev polynomials, on every lane of six rows.
__attribute__((target_clones("avx2", "default"))) void rows_to_chebyshev(double (*c)[kRow]) {
  for (int k = 0; k < kRow; ++k) {
    const double c0 = c[0][k], c1 = c[1][k], c2 = c[2][k], c3 = c[3][k], c4 = c[4][k], c5 = c[5][k];
    c[0][k] = c0 + 0.5 * c2 + 0.375 * c4;
    c[1][k] = c1 + 0.75 * c3 + 0.625 * c5;
    c[2][k] = 0.5 * (c2 + c4);
    c[3][k] = 0.25 * c3 + 0.3125 * c5;
    c[4][k] = 0.125 * c4;
    c[5][k] = 0.0625 * c5;
  }
}

void transpose(const double (*from)[kRow], double (*to)[kRow]) {
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < kN; ++j) to[i][j] = from[j][i];
}

}  // namespace

void add(Series& a, double s, const Series& b) {
  double* to = &a.c[0][0];
  const double* from = &b.c[0][0];
  for (int k = 0; k < kN * kRow; ++k) to[k] += s * from[k];
}

Series product(const Series& a, const Series& b) {
  double rows[kN][2 * kRow] = {};
  convolve(a.c, b.c, rows);
  Series out;
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j < kN - i; ++j) out.c[i][j] = rows[i][j];
  return out;
}

Series derivative_s(const Series& a) {
  Series out;
  for (int i = 0; i + 1 < kN; ++i)
    for (int j = 0; j < kRow; ++j) out.c[i][j] = (i + 1) * a.c[i + 1][j];
  return out;
}

Series derivative_t(const Series& a) {
  Series out;
  for (int i = 0; i < kN; ++i)
    for (int j = 0; j + 1 < kN; ++j) out.c[i][j] = (j + 1) * a.c[i][j + 1];
  return out;
}

Series chebyshev(const Series& a) {
  Series rows = a, columns;
  rows_to_chebyshev(rows.c);
  transpose(rows.c, columns.c);
  rows_to_chebyshev(columns.c);
  transpose(columns.c, rows.c);
  return rows;
}

double magnitude(const Series& a) {
  const double* c = &a.c[0][0];
  double lane[kRow] = {};
  for (int i = 0; i < kN; ++i)
    for (int k = 0; k < kRow; ++k) lane[k] += std::abs(c[i * kRow + k]);
  return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + (lane[4] + lane[5]);
}

double variation(const Series& a) {
  return magnitude(a) - std::abs(a.c[0][0]);
}

double bound_of(const Series& a) {
  return magnitude(chebyshev(a));
}

void measure(Bounded& a) {
  for (int d = 0; d < kN; ++d) {
    double sum = 0, sum_s = 0, sum_t = 0;
    for (int j = 0; j <= d; ++j) {
      const double size = std::abs(a.p.c[d - j][j]);
      sum += size, sum_s += (d - j) * size, sum_t += j * size;
    }
    const auto k = static_cast<std::size_t>(d);
    a.norm[k] = sum, a.norm_s[k] = sum_s, a.norm_t[k] = sum_t;
  }
}

// With A_k the sum of a's coefficients of degree k: what is dropped is at most Σ A_k B_l over k + l > 5; its
// derivative by s at most Σ A'_k B_l + A_k B'_l, the coefficients of A' weighted with their powers of s.
Bounded product(const Bounded& a, const Bounded& b) {
  Bounded out;
  out.p = product(a.p, b.p);
  Remainder size_a, size_b, dropped, above{};  // above: the sum of b's from degree 6 − k on
  for (int k = 0; k < kN; ++k) {
    const auto i = static_cast<std::size_t>(k), top = static_cast<std::size_t>(kN - k);
    size_a = size_a + Remainder{a.norm[i], a.norm_s[i], a.norm_t[i]};
    size_b = size_b + Remainder{b.norm[i], b.norm_s[i], b.norm_t[i]};
    if (k > 0) above = above + Remainder{b.norm[top], b.norm_s[top], b.norm_t[top]};
    dropped.value += a.norm[i] * above.value;
    dropped.ds += a.norm_s[i] * above.value + a.norm[i] * above.ds;
    dropped.dt += a.norm_t[i] * above.value + a.norm[i] * above.dt;
  }
  const Remainder &r = a.r, &q = b.r;
  out.r.value = dropped.value + size_a.value * q.value + size_b.value * r.value + r.value * q.value;
  out.r.ds = dropped.ds + size_a.ds * q.value + size_a.value * q.ds + size_b.ds * r.value +
             size_b.value * r.ds + r.ds * q.value + r.value * q.ds;
  out.r.dt = dropped.dt + size_a.dt * q.value + size_a.value * q.dt + size_b.dt * r.value +
             size_b.value * r.dt + r.dt * q.value + r.value * q.dt;
  measure(out);
  return out;
}

}  // namespace dupin
