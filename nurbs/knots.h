// B-spline bases: knot spans and the derivatives of basis functions.
//
// A knot vector here is always the full one, every knot repeated by its multiplicity: n poles of degree p
// have n + p + 1 knots, non-decreasing. It need not be clamped, so a periodic spline is written with its
// first p poles repeated at the end; its domain is [knots[p], knots[n]].
#ifndef DUPIN_NURBS_KNOTS_H
#define DUPIN_NURBS_KNOTS_H

#include <span>
#include <vector>

namespace dupin {

inline constexpr int kMaxDegree = 25;  ///< OCCT's own limit; the reader refuses more
inline constexpr int kMaxDerivative = 3;

/// The index s with knots[s] <= t < knots[s+1], p <= s < n; the last non-empty span at and beyond the end.
/// With `from_left` the span that ends at t where t is a knot (for one-sided derivatives).
int find_span(std::span<const double> knots, int degree, double t, bool from_left = false);

/// Values and derivatives up to `order` of the degree + 1 basis functions of `span` at t.
/// out[k * (degree + 1) + j] is the k-th derivative of the j-th; derivatives above the degree are 0.
void basis_derivatives(std::span<const double> knots, int degree, int span, double t, int order, double* out);

}  // namespace dupin

#endif
