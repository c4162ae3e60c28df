// Inside the folder: least-squares planes, spheres, cylinders, cones, tori and axes of revolution through
// points with normals.
#ifndef DUPIN_NURBS_SHAPE_FIT_H
#define DUPIN_NURBS_SHAPE_FIT_H

#include <optional>
#include <vector>

#include "surface.h"

namespace dupin {

struct OrientedPoint {
  Vec3 p, n;  ///< n unit
};

/// The kinds in the order in which they are tried, simplest first.
enum class ShapeKind { plane, sphere, cylinder, cone, torus };

/// A shape of `kind` near the points, with an arbitrary frame; empty if the points do not determine one. Not
/// yet checked against anything: see `signed_distance`.
std::optional<Surface> fit_shape(ShapeKind kind, const std::vector<OrientedPoint>& points);

/// The signed distance of a point from a plane, sphere, cylinder, cone (the nappe with positive radius) or
/// torus.
double signed_distance(const Surface& shape, const Vec3& p);

/// A line that all normals meet: the axis of a surface of revolution.
struct Axis {
  Vec3 origin, direction;
};
std::optional<Axis> fit_axis(const std::vector<OrientedPoint>& points);

}  // namespace dupin

#endif
