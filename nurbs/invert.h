// From a point in space to the parameters of the surface's point nearest to it.
#ifndef DUPIN_NURBS_INVERT_H
#define DUPIN_NURBS_INVERT_H

#include <optional>

#include "../core/vec.h"
#include "surface.h"

namespace dupin {

/// Parameters of the point of the surface that is nearest to p, near `guess`.
/// Plane, cylinder, cone, sphere, torus: in closed form, angles as close to the guess's as whole turns can
/// bring them; where the nearest point does not tell an angle (on an axis), the guess's is kept. Of a double
/// cone the nappe is the guess's. Other kinds: Newton's method from the guess (of a revolution or extrusion
/// only the profile's parameter is guessed), kept within the domain (periodic directions run on), at most
/// kInvertSteps steps, each of which must come nearer. Empty if it did not converge.
std::optional<Vec2> invert(const Surface& surface, const Vec3& p, Vec2 guess);

inline constexpr int kInvertSteps = 60;

}  // namespace dupin

#endif
