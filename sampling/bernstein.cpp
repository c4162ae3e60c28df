#include "bernstein.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dupin::bernstein {
namespace {

constexpr int kMaxBinomial = 60;

struct BinomialTable {
  std::array<std::array<double, kMaxBinomial + 1>, kMaxBinomial + 1> c{};
  BinomialTable() {
    for (int n = 0; n <= kMaxBinomial; ++n) {
      c[n][0] = c[n][n] = 1;
      for (int k = 1; k < n; ++k) c[n][k] = c[n - 1][k - 1] + c[n - 1][k];
    }
  }
};

void add_product_plainly(const Net& a, const Net& b, double factor, Net& out) {
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j)
      for (int k = 0; k <= b.p; ++k)
        for (int l = 0; l <= b.q; ++l) out.at(i + k, j + l) += a.at(i, j) * (factor * b.at(k, l));
}

}  // namespace

std::span<const double> binomials(int n) {
  static const BinomialTable table;
  return {table.c[static_cast<std::size_t>(n)].data(), static_cast<std::size_t>(n + 1)};
}

namespace {

/// to[k] += s · from[k]; one operation an element, so that every clone gives the same bits.
__attribute__((target_clones("avx2", "default"))) void add_rows(const double* a, int a_count,
                                                                const double* rows, int length, double* to) {
  for (int i = 0; i < a_count; ++i) {
    const double s = a[i];
    for (int k = 0; k < length; ++k) to[i + k] += s * rows[k];
  }
}

/// Nets with a row of more than this many entries take the plain way.
constexpr int kMaxPadded = 1024;

}  // namespace

// With b's rows padded to the product's width a product of two nets is one of two long vectors (Kronecker's
// substitution): the inner loop runs over all of b at once.
void add_product(const Net& a, const Net& b, double factor, Net& out) {
  const int width = out.q + 1, length = b.p * width + b.q + 1;
  double padded[kMaxPadded];
  if (length > kMaxPadded) return add_product_plainly(a, b, factor, out);
  std::fill(padded, padded + length, 0.0);
  for (int k = 0; k <= b.p; ++k)
    for (int l = 0; l <= b.q; ++l) padded[k * width + l] = factor * b.at(k, l);
  for (int i = 0; i <= a.p; ++i)
    add_rows(a.c.data() + i * (a.q + 1), a.q + 1, padded, length, out.c.data() + i * width);
}

void multiply(const Net& a, const Net& b, Net& out) {
  out.reset(a.p + b.p, a.q + b.q);
  add_product(a, b, 1, out);
}

// With scaled entries a_i = C(p,i) b_i the derivative's entry is (i+1) a_{i+1} − (p−i) a_i.
void derivative_u(const Net& a, Net& out) {
  if (a.p == 0) return out.reset(0, a.q);
  out.reset(a.p - 1, a.q);
  for (int i = 0; i < a.p; ++i)
    for (int j = 0; j <= a.q; ++j) out.at(i, j) = (i + 1) * a.at(i + 1, j) - (a.p - i) * a.at(i, j);
}

void derivative_v(const Net& a, Net& out) {
  if (a.q == 0) return out.reset(a.p, 0);
  out.reset(a.p, a.q - 1);
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j < a.q; ++j) out.at(i, j) = (j + 1) * a.at(i, j + 1) - (a.q - j) * a.at(i, j);
}

Range range(const Net& a) {
  const auto bp = binomials(a.p), bq = binomials(a.q);
  Range r{a.c[0], a.c[0]};
  for (int i = 0; i <= a.p; ++i)
    for (int j = 0; j <= a.q; ++j) {
      const double b = a.at(i, j) / (bp[i] * bq[j]);
      r.lo = std::min(r.lo, b), r.hi = std::max(r.hi, b);
    }
  return r;
}

double magnitude(const Net& a) {
  return range(a).magnitude();
}

// s·Σ d_i C(p−1,i) s^i(1−s)^(p−1−i): entry i+1 of the degree p net is d_i C(p−1,i), so dividing only shifts.
void divide_by_side(const Net& a, Side side, Net& out) {
  const bool along_u = side == Side::u0 || side == Side::u1;
  const int shift = side == Side::u0 || side == Side::v0 ? 1 : 0;
  if (along_u) {
    out.reset(std::max(0, a.p - 1), a.q);
    for (int i = 0; i < a.p; ++i)
      for (int j = 0; j <= a.q; ++j) out.at(i, j) = a.at(i + shift, j);
  } else {
    out.reset(a.p, std::max(0, a.q - 1));
    for (int i = 0; i <= a.p; ++i)
      for (int j = 0; j < a.q; ++j) out.at(i, j) = a.at(i, j + shift);
  }
}

}  // namespace dupin::bernstein
