// Surfaces as exact evaluators: analytic kinds, B-spline/NURBS, revolution, extrusion and offset.
//
// Parametrisations are those of ISO 10303-42 and OCCT, with the frame's axes X, Y, Z:
//   plane     O + u·X + v·Y                                    cylinder  O + r(cos u·X + sin u·Y) + v·Z
//   cone      O + (r + v·sin α)(cos u·X + sin u·Y) + v·cos α·Z  sphere    O + r cos v(cos u·X + sin u·Y) + r
//   sin v·Z torus     O + (R + r cos v)(cos u·X + sin u·Y) + r sin v·Z revolution  rotation by u about the
//   axis of profile(v)      extrusion  profile(u) + v·direction offset    base(u,v) + distance · n(u,v), n =
//   Su × Sv normalised
// Angles are radians. A left-handed frame is allowed: its surface normal Su × Sv then points the other way.
#ifndef DUPIN_NURBS_SURFACE_H
#define DUPIN_NURBS_SURFACE_H

#include <memory>
#include <string_view>
#include <variant>
#include <vector>

#include "../core/status.h"
#include "../core/vec.h"
#include "curve.h"

namespace dupin {

struct Plane {
  Frame3 frame;
};
struct Cylinder {
  Frame3 frame;
  double radius = 0;
};
struct Cone {
  Frame3 frame;
  double radius = 0;      ///< at v = 0
  double half_angle = 0;  ///< α, in (-π/2, π/2), not 0
};
struct Sphere {
  Frame3 frame;
  double radius = 0;
};
struct Torus {
  Frame3 frame;
  double major = 0, minor = 0;
};
struct BsplineSurface {
  int degree_u = 0, degree_v = 0;
  std::vector<double> knots_u, knots_v;  ///< full, see knots.h
  int count_u = 0, count_v = 0;
  std::vector<Vec3> poles;      ///< poles[i * count_v + j], i along u
  std::vector<double> weights;  ///< like the poles; empty: all 1 (polynomial)
  bool periodic_u = false, periodic_v = false;
};
struct Revolution {
  Vec3 axis_origin, axis_direction;  ///< unit direction
  Curve3 profile;
};
struct Extrusion {
  Curve3 profile;
  Vec3 direction;  ///< unit
};
struct Surface;
struct OffsetSurface {
  std::shared_ptr<const Surface> base;
  double distance = 0;
};

struct Surface {
  std::variant<Plane, Cylinder, Cone, Sphere, Torus, BsplineSurface, Revolution, Extrusion, OffsetSurface>
      geometry;
};

/// "plane", "cylinder", … , in the variant's order.
std::string_view kind_name(const Surface& surface);
/// Plane, cylinder, cone or sphere: one quadric DP is the surface itself.
bool is_quadric(const Surface& surface);

/// Ok, or what is wrong, with the value and its index: a pole, weight, knot or radius that is not finite or
/// out of range, knots that decrease or are too few, a degree of 0 or above kMaxDegree, a frame that is not
/// orthonormal. Everything that takes a surface expects one that passes.
Status check(const Surface& surface);

/// The surface's point and partial derivatives. Members above the order that was asked for are zero.
struct SurfaceJet {
  Vec3 p;
  Vec3 pu, pv;
  Vec3 puu, puv, pvv;
  Vec3 puuu, puuv, puvv, pvvv;
};

/// An evaluated derivative is wrong by at most kEvaluateError · extent · rate_uⁱ · rate_vʲ for ∂ⁱ⁺ʲ/∂uⁱ∂vʲ (a
/// position also by 2 ulp of its coordinates), wherever the surface lies. The extent is that of the poles, or
/// the radii and lengths of other kinds; the rate is 1 for angles and lengths, and 2 · degree · (largest /
/// smallest weight) / (shortest knot span) for splines.
inline constexpr double kEvaluateError = 1e-14;

/// Which of two one-sided derivatives is meant where the parameter is a knot (or the seam of a periodic
/// spline).
struct Sides {
  bool u_from_left = false, v_from_left = false;
};

/// Point and derivatives to `order` (0 … 3). B-splines are clamped to their domain, or wrapped if periodic.
/// An offset is not finite where its base has no normal, not even as a limit.
SurfaceJet evaluate(const Surface& surface, double u, double v, int order, Sides sides = {});
inline Vec3 point_at(const Surface& surface, double u, double v) {
  return evaluate(surface, u, v, 0).p;
}

/// The natural parameter domain; infinite where the surface is.
Box2 domain(const Surface& surface);
/// The period in u (v), or 0 where the surface does not close on itself smoothly.
double period_u(const Surface& surface);
double period_v(const Surface& surface);

/// Unit normal and principal curvatures at a point, by the symmetric shape operator in an orthonormal tangent
/// frame. |k1| >= |k2|; d1, d2 are unit, d1 × d2 = n; a curvature is positive when the surface bends towards
/// n.
struct Curvature {
  enum class Kind : unsigned char {
    regular,
    umbilic,         ///< k1 = k2 to rounding; d1 is the best projection of the x, y, z axes
    singular_limit,  ///< Su × Sv vanishes here; the limit along an interior direction was taken
    undefined        ///< no limit exists; the members are not finite
  };
  Vec3 n, d1, d2;
  double k1 = 0, k2 = 0;
  Kind kind = Kind::regular;
};
/// Largest error of a curvature from an exact jet, times |Suu|/a² + |Suv|/(ad) + |Svv|/d² with the lengths a,
/// d of Su and of the part of Sv across it (for partials at an angle of θ divided by sin θ, by which the
/// normal is uncertain).
inline constexpr double kCurvatureError = 1e-15;
/// Largest error of a limit: of the normal, and of curvatures in relation to their size beside the singular
/// point.
inline constexpr double kLimitError = 1e-8;

/// From a jet of order 2 or more. Never singular_limit: that needs the surface.
Curvature principal_curvature(const SurfaceJet& jet);
/// The same at (u,v), with limits at poles and collapsed edges; `inside` is a point of the domain towards
/// which limits are taken.
Curvature principal_curvature(const Surface& surface, double u, double v, Vec2 inside);

}  // namespace dupin

#endif
