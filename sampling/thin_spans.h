// Knot spans that are far thinner than their neighbours, and hold nothing of their own.
//
// Modelling kernels leave pairs of knots that all but coincide. A span of a ten-thousandth of its neighbour's
// width would be cut into cells about as long as they are wide, hundreds of them; where the neighbour's own
// polynomial, carried on, is the surface there, it takes the span in.
#ifndef DUPIN_SAMPLING_THIN_SPANS_H
#define DUPIN_SAMPLING_THIN_SPANS_H

#include <vector>

#include "fitted_patches.h"

namespace dupin {

/// What carrying on a neighbour may be off, in model units and radians.
struct ThinSpanTolerances {
  double position = 0, normal = 0;
};

/// Removes whole columns and rows of a spline's grid of patches; the neighbours that took them in say by
/// position_error and normal_error how far they are off. `patches` must be affine in u and v. Patches that
/// are no full grid stay as they are.
void absorb_thin_spans(std::vector<FittedPatch>& patches, const ThinSpanTolerances& tolerances);

}  // namespace dupin

#endif
