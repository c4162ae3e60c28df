// Scenes of DPs made by hand from closed forms, without the sampler.
#ifndef DUPIN_TESTS_RENDER_HAND_MADE_H
#define DUPIN_TESTS_RENDER_HAND_MADE_H

#include "../../sampling/quadric_dp.h"

namespace dupin::testing {

/// One part of DPs, each a face of its own unless told otherwise, placed by `placements` (once, where it is,
/// if there are none).
struct HandMade {
  Model model;
  DpScene dps;

  HandMade();
  PartDps& pieces() { return dps.parts[0]; }
  /// Adds the DP as a new face and keeps the part's box.
  QuadricDp& add(const QuadricDp& dp);
  void place(const Affine3& to_world);
};

/// Axes: u, v and n = u × v through the origin.
QuadricDp plane_rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double width, double height);
/// The whole of a cylinder whose axis runs along u, from x = 0 to length, its top line through the origin.
QuadricDp whole_cylinder(const Vec3& origin, const Vec3& u, const Vec3& v, double radius, double length);
/// The whole sphere that touches the plane through the origin from below n.
QuadricDp whole_sphere(const Vec3& origin, const Vec3& u, const Vec3& v, double radius);
/// A cone around `axis` from the apex, of half-angle α, to the distance `length` along the axis; adds its two
/// planes to the part.
QuadricDp whole_cone(PartDps& part, const Vec3& apex, const Vec3& axis, double half_angle, double length);
/// A saddle or bowl: curvatures λu, λv, and a, b, c as given, over a square of half-width `half`.
QuadricDp bent_square(const Vec3& origin, const Vec3& u, const Vec3& v, double lambda_u, double lambda_v,
                      const Vec3& abc, double half);

/// A turn by an angle about an axis, then a shift.
Affine3 rigid(const Vec3& axis, double angle, const Vec3& shift);

/// A scene that has every kind: a plate with an elliptic hole, arcs and lines for an outline, a cylinder, a
/// sphere, a cone, a saddle.
HandMade every_kind();

/// The scene with its part's own coordinates scaled about the origin, then shifted.
HandMade moved(HandMade scene, double scale, const Vec3& shift);

}  // namespace dupin::testing

#endif
