// Bounding spheres of triangles and of up to four spheres, after Chen & Nguyen 2001, section 3.1.
#ifndef DUPIN_SIMPLIFY_BOUNDING_SPHERE_H
#define DUPIN_SIMPLIFY_BOUNDING_SPHERE_H

#include <span>

#include "../core/vec.h"

namespace dupin {

struct Sphere {
  Vec3 center;
  double radius = 0;
};

/// Of a triangle: its circumcircle where no angle is larger than 90°, else the circle over its longest edge.
/// The smallest sphere there is.
Sphere triangle_sphere(const Vec3& a, const Vec3& b, const Vec3& c);

/// Of two to four spheres. One that contains the others is the answer; else
///   two:   (d + r1 + r2) / 2 on the line of the centres;
///   three: the circle of the centres' triangle, and the largest of the radii;
///   four:  for each three the smallest sphere with its centre on the axis of their circle; the best of
///   these.
/// The published rules treat unequal radii generously, so the result is tightened towards the smallest
/// sphere, and verified: it contains all spheres up to rounding.
Sphere sphere_of_spheres(std::span<const Sphere> spheres);

/// As published, without the tightening; for comparison.
Sphere published_sphere_of_spheres(std::span<const Sphere> spheres);

/// Contains all spheres, no larger than around `start`'s centre, and near the smallest there is.
Sphere tightened_sphere(const Vec3& start, std::span<const Sphere> spheres);

/// The smallest radius around `center` that contains all spheres.
double radius_around(const Vec3& center, std::span<const Sphere> spheres);

}  // namespace dupin

#endif
