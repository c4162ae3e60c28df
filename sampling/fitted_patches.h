// Bézier patches for surfaces that are not rational: offsets, and sweeps of offset curves or hyperbolas.
//
// An APPROXIMATION, and the only one whose error is estimated by samples rather than bounded by coefficients:
// DPs made from these patches say so (QuadricDp::sampled_bound).
#ifndef DUPIN_SAMPLING_FITTED_PATCHES_H
#define DUPIN_SAMPLING_FITTED_PATCHES_H

#include <functional>
#include <vector>

#include "../nurbs/bezier.h"
#include "tolerance_field.h"

namespace dupin {

/// The biquintic that interpolates a function of (u,v) at Chebyshev nodes of a box.
BezierPatch interpolating_patch(const std::function<Vec3(Vec2)>& at, const Box2& box);

struct FittedPatch {
  BezierPatch patch;  ///< biquintic, u and v affine in its parameters
  double position_error = 0,
         normal_error = 0;  ///< twice the largest found at the samples; model units, radians
};

/// Interpolants at Chebyshev nodes over pieces of `region`, halved until the sampled errors are a tenth of
/// the tolerances. Empty if the surface is not defined (not finite) somewhere.
std::vector<FittedPatch> fitted_patches(const Surface& surface, const Box2& region,
                                        const ToleranceField& tolerance, double normal_tolerance);

}  // namespace dupin

#endif
