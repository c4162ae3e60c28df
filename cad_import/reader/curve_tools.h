// Moving curves in the plane, and the smallest box of a piece of one.
#ifndef DUPIN_CAD_IMPORT_READER_CURVE_TOOLS_H
#define DUPIN_CAD_IMPORT_READER_CURVE_TOOLS_H

#include <optional>

#include "../../nurbs/curve.h"
#include "../../nurbs/surface.h"

namespace dupin::reader {

void translate(Curve2& curve, Vec2 by);

/// The curve t ↦ curve(a + b·t), b > 0; none for conics with b ≠ 1.
std::optional<Curve2> reparametrized(const Curve2& curve, double a, double b);

/// A curve that lies in (or projects to) a plane, in the plane's parameters: the projection is affine, so
/// every kind stays what it is. None for conics that are tilted out of the plane, and offsets.
std::optional<Curve2> in_plane(const Curve3& curve, const Frame3& plane);

/// Straight from a to b while t runs over [t0, t1].
Curve2 segment(Vec2 a, Vec2 b, double t0, double t1);

/// Contains the curve over [t0, t1], to within rounding.
Box2 bounds(const Curve2& curve, double t0, double t1);

}  // namespace dupin::reader

#endif
