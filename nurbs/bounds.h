// Rigorous bounds of Bézier patches and curves from their control points.
#ifndef DUPIN_NURBS_BOUNDS_H
#define DUPIN_NURBS_BOUNDS_H

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezier.h"

namespace dupin {

/// Contains the whole patch (curve): the box of its poles. Infinite if a weight is not positive.
Box3 bounding_box(const BezierPatch& patch);
Box3 bounding_box(const BezierCurve3& curve);

/// Directions within `angle` radians of `axis`.
struct NormalCone {
  Vec3 axis;         ///< unit; zero when nothing is known
  double angle = 0;  ///< below π/2, or π: every direction
  bool bounded() const { return angle < 1.5707963267948966; }
};

/// Contains Su × Sv everywhere on the patch where it does not vanish: the cone of the Bernstein coefficients
/// of w³ Su × Sv. Coefficients below 1e-13 of the largest are taken for zero (collapsed edges).
NormalCone normal_cone(const BezierPatch& patch);

/// Both principal curvatures, of the normal Su × Sv, lie in [lo, hi] everywhere on the patch.
struct CurvatureBounds {
  double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
  bool bounded() const { return std::isfinite(lo) && std::isfinite(hi); }
  /// The largest of their absolute values.
  double largest() const { return std::max(std::abs(lo), std::abs(hi)); }
};
/// From the Bernstein coefficients of both fundamental forms. Unbounded for patches that turn or stretch too
/// much (halve them), that have a singular point, and for rational ones of a degree above kMaxTensorDegree
/// / 4. As patches are halved, what the bounds say too much is halved too.
CurvatureBounds curvature_bounds(const BezierPatch& patch);

/// Whether some direction of the cone may point towards the viewer: false says that the patch, if its outward
/// normal is the cone's, is turned away from every eye in the direction `to_eye` (unit) give or take `spread`
/// radians.
bool may_face(const NormalCone& cone, const Vec3& to_eye, double spread);

}  // namespace dupin

#endif
