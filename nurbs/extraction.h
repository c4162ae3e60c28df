// Inside the folder: cutting a spline's domain at its knots, and the matrices that turn its active poles into
// Bézier poles.
#ifndef DUPIN_NURBS_EXTRACTION_H
#define DUPIN_NURBS_EXTRACTION_H

#include <span>
#include <vector>

namespace dupin {

/// Part of one knot span: [t0, t1] as the caller's parameters, which are `shift` (whole periods) past the
/// knots'.
struct SplinePiece {
  double t0, t1, shift;
  int span;
};
/// The pieces of [t0, t1]; clamped to the domain unless periodic. Pieces that are nothing but rounding are
/// merged into their neighbours.
std::vector<SplinePiece> spline_pieces(std::span<const double> knots, int degree, bool periodic, double t0,
                                       double t1);

/// matrix[k * (degree + 1) + j]: the weight of active pole span − degree + j in the piece's k-th Bézier pole.
void extraction_matrix(std::span<const double> knots, int degree, const SplinePiece& piece, double* matrix);

}  // namespace dupin

#endif
