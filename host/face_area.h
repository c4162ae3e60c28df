// The area of a face within its trims.
#ifndef DUPIN_HOST_FACE_AREA_H
#define DUPIN_HOST_FACE_AREA_H

#include "../nurbs/model.h"

namespace dupin {

/// In squares of the part's unit, by Green's theorem along the loops and Gauss quadrature: for a person to
/// read, not certified. About 1e-6 of the area where the surface is smooth, 1e-3 where knots or singular
/// points lie inside.
double face_area(const Part& part, const Face& face);

}  // namespace dupin

#endif
