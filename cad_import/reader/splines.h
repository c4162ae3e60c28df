// Knots and weights as OCCT stores them (distinct knots with multiplicities) and as we do (full).
#ifndef DUPIN_CAD_IMPORT_READER_SPLINES_H
#define DUPIN_CAD_IMPORT_READER_SPLINES_H

#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>

#include <vector>

namespace dupin::reader {

/// The full knot vector (nurbs/knots.h). A periodic spline with n poles gets n + 2·degree + 1 knots, for n +
/// degree poles of which the last `degree` repeat the first.
std::vector<double> full_knots(const TColStd_Array1OfReal& knots,
                               const TColStd_Array1OfInteger& multiplicities, int degree, bool periodic);

/// Empties `weights` if they are all the same: the spline is polynomial.
void drop_equal_weights(std::vector<double>& weights);

}  // namespace dupin::reader

#endif
