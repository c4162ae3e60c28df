// Polynomials of two variables in Bernstein form over [0,1]²: products, derivatives, ranges.
//
// Nets are kept *scaled*: entry (i,j) of a net of bidegree (p,q) is the Bernstein coefficient times
// C(p,i)·C(q,j). A product of two polynomials is then the plain convolution of their nets. By the convex hull
// property the unscaled coefficients bound the polynomial over [0,1]²: that is where every certificate of
// this folder comes from.
#ifndef DUPIN_SAMPLING_BERNSTEIN_H
#define DUPIN_SAMPLING_BERNSTEIN_H

#include <span>
#include <vector>

namespace dupin::bernstein {

/// Binomial coefficients C(n, 0 … n); n up to 60.
std::span<const double> binomials(int n);

struct Range {
  double lo = 0, hi = 0;
  double magnitude() const { return -lo > hi ? -lo : hi; }
  double width() const { return hi - lo; }
};

/// A scaled net; c[i * (q + 1) + j].
struct Net {
  int p = 0, q = 0;
  std::vector<double> c;
  void reset(int degree_p, int degree_q) {
    p = degree_p, q = degree_q;
    c.assign(static_cast<std::size_t>((p + 1) * (q + 1)), 0.0);
  }
  double& at(int i, int j) { return c[static_cast<std::size_t>(i * (q + 1) + j)]; }
  double at(int i, int j) const { return c[static_cast<std::size_t>(i * (q + 1) + j)]; }
};

/// out = a·b.
void multiply(const Net& a, const Net& b, Net& out);
/// out += factor · a·b; out has the product's degrees already.
void add_product(const Net& a, const Net& b, double factor, Net& out);
/// Derivative by the first (second) parameter; a zero net of degree 0 for degree 0.
void derivative_u(const Net& a, Net& out);
void derivative_v(const Net& a, Net& out);
/// Smallest and largest unscaled coefficient: contains the polynomial's values over [0,1]².
Range range(const Net& a);
/// Largest absolute unscaled coefficient.
double magnitude(const Net& a);

/// A side of the unit square along which a net vanishes.
enum class Side { u0, u1, v0, v1 };
/// Divides by the parameter that vanishes on `side` (s, 1−s, t, 1−t); the net must be zero there, and is
/// forced to be.
void divide_by_side(const Net& a, Side side, Net& out);

}  // namespace dupin::bernstein

#endif
