// Splines and swept surfaces that are a plane, cylinder, cone, sphere, torus or surface of revolution.
//
// CAD systems export many fillets, bores and lathed shapes as B-splines. What is recognised is the set of
// points in space, not the parametrisation: parameters of points are found by `invert` (invert.h) on the
// recognised surface, and a face's trims by their curves in space. The recognised surface's frame is chosen
// so that
//   - its normal Su × Sv points to the side of the original's (left-handed frames do that),
//   - the middle of the region lies opposite the seam, at u = π, and on a sphere on the equator, which runs
//   along the region's
//     longer side: a region of less than a whole turn meets no seam in u.
// Rational splines that are quadrics or tori exactly deviate by rounding alone, about 1e-15 of their extent.
#ifndef DUPIN_NURBS_RECOGNIZE_H
#define DUPIN_NURBS_RECOGNIZE_H

#include <optional>

#include "surface.h"

namespace dupin {

/// A tolerance for `recognize` that files written with 7 or more digits meet: times the region's extent.
inline constexpr double kRecognitionTolerance = 1e-7;
/// The largest turn of a normal that is accepted, radians.
inline constexpr double kRecognitionAngle = 1e-4;

struct Recognized {
  Surface surface;
  /// Certified: no point of the original over the region is farther from the recognised surface, in model
  /// units. Bernstein coefficients of the implicit form along the original bound it, not samples.
  double deviation = 0;
  /// Certified likewise: the largest angle between the normals, radians, where the original's |Su × Sv| is at
  /// least about 1e-3 of its largest on the same Bézier patch; nearer to a collapsed edge nothing is said.
  double normal_deviation = 0;
};

/// The simplest surface within `tolerance` (model units) of `surface` over `uv_box`: plane, sphere, cylinder,
/// cone, torus, and for B-splines also a revolution of one of its own isoparametric curves. Empty if there is
/// none, if `surface` is of such a kind already, or if nothing could be certified. Offsets are recognised
/// when their base is of an analytic kind, exactly.
std::optional<Recognized> recognize(const Surface& surface, const Box2& uv_box, double tolerance);

struct Model;
/// Sets Face::recognized of every face whose surface is recognised within kRecognitionTolerance times the
/// face's extent, in parallel over faces. Returns how many were.
int recognize_faces(Model& model);

}  // namespace dupin

#endif
