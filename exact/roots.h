// Real roots of polynomials, by isolation: slow and sure.
#ifndef DUPIN_EXACT_ROOTS_H
#define DUPIN_EXACT_ROOTS_H

#include <span>
#include <vector>

namespace dupin::exact {

/// Σ c[i] tⁱ, in long double.
using Power = std::vector<long double>;

/// The roots of odd multiplicity in [lo, hi], ascending: between neighbouring roots of the derivative a
/// polynomial is monotone, and a change of sign is closed in by Newton's method held in a bracket. A root at
/// which the sign does not change (a ray that touches and does not enter) is none.
std::vector<long double> roots_between(const Power& polynomial, long double lo, long double hi);

/// The parameters in (0,1) at which a polynomial in Bernstein form changes sign, ascending, to `kRootWidth`.
inline constexpr double kRootWidth = 1e-15;
std::vector<double> bernstein_sign_changes(std::span<const double> coefficients);

}  // namespace dupin::exact

#endif
