// Polynomials of two variables of total degree 5 over the square [−1,1]², with a bound on what they leave
// out.
//
// A smooth function over a small cell is such a polynomial and a remainder: what a cell's certificate needs
// of it is far cheaper than products of tensor nets, and does not depend on the degree or the weights of the
// surface. A polynomial is bounded through its Chebyshev coefficients: |Σ c_kl T_k(s) T_l(t)| <= Σ |c_kl|.
// Series arithmetic with rigorous remainders is known as Taylor models (Berz, Makino).
#ifndef DUPIN_SAMPLING_SERIES_H
#define DUPIN_SAMPLING_SERIES_H

#include <array>

namespace dupin {

inline constexpr int kSeriesDegree = 5;

/// c[i][j] s^i t^j, or c[i][j] T_i(s) T_j(t); i + j <= 5, what lies beyond is 0.
struct Series {
  static constexpr int kRows = kSeriesDegree + 1, kRow = 8;
  alignas(32) double c[kRows][kRow] = {};
};

/// Bounds over the square: of a function, and of its derivatives by s and t.
struct Remainder {
  double value = 0, ds = 0, dt = 0;
};
inline Remainder operator+(const Remainder& a, const Remainder& b) {
  return {a.value + b.value, a.ds + b.ds, a.dt + b.dt};
}
inline Remainder operator*(const Remainder& a, double s) {
  return {a.value * s, a.ds * s, a.dt * s};
}

/// a += s·b
void add(Series& a, double s, const Series& b);
Series product(const Series& a, const Series& b);  ///< what exceeds the degree is dropped
Series derivative_s(const Series& a);
Series derivative_t(const Series& a);
/// From powers to Chebyshev polynomials.
Series chebyshev(const Series& a);
/// Σ |c|, the constant term left out.
double variation(const Series& chebyshev_coefficients);
/// Σ |c|: bounds a polynomial given by its Chebyshev (or power) coefficients.
double magnitude(const Series& chebyshev_coefficients);
/// Largest absolute value: magnitude of its Chebyshev form.
double bound_of(const Series& a);

/// A function: a polynomial in powers and the rest.
struct Bounded {
  Series p;
  Remainder r;
  /// Of each degree: Σ |c|, Σ i|c|, Σ j|c|; see `measure`.
  std::array<double, kSeriesDegree + 1> norm{}, norm_s{}, norm_t{};
};
void measure(Bounded& a);
/// Of measured factors; the product is measured.
Bounded product(const Bounded& a, const Bounded& b);

}  // namespace dupin

#endif
