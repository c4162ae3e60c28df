// Curves that a file does not have, fitted to within a tolerance: the pcurve of a space curve on a surface,
// and the space curve of a pcurve. Both are piecewise cubics with continuous tangents.
#ifndef DUPIN_CAD_IMPORT_READER_CURVE_FIT_H
#define DUPIN_CAD_IMPORT_READER_CURVE_FIT_H

#include <optional>

#include "../../nurbs/curve.h"
#include "../../nurbs/surface.h"

namespace dupin::reader {

/// The parameters in `domain` at which the surface is nearest to p: Newton's method from the nearest of a
/// grid of points, or from `near` where that is given.
Vec2 project(const Surface& surface, const Box2& domain, const Vec3& p, const Vec2* near);

/// The curve over [t0, t1] in the surface's parameters, unwrapped across periods. `domain` is where the face
/// lies (finite; a guess that may be too large). Aims at `tolerance` along the surface; how far it got is for
/// the caller to measure. None where it is not finite.
std::optional<Curve2> fit_pcurve(const Surface& surface, const Box2& domain, const Curve3& curve, double t0,
                                 double t1, double tolerance);

/// surface(pcurve(t)) over [t0, t1], likewise.
std::optional<Curve3> fit_curve(const Surface& surface, const Curve2& pcurve, double t0, double t1,
                                double tolerance);

}  // namespace dupin::reader

#endif
