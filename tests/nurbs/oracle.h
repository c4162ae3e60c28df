// A slow, independent oracle: surfaces and curves in 100-digit arithmetic, straight from their definitions.
//
// It knows positions only: B-splines by the recursive Cox–de Boor definition, the other kinds by the formulas
// of ISO 10303-42. Derivatives are finite differences with steps so small that 100 digits leave them exact to
// far more than double precision; curvatures come from the first and second fundamental forms, H ± sqrt(H² −
// K).
#ifndef DUPIN_TESTS_NURBS_ORACLE_H
#define DUPIN_TESTS_NURBS_ORACLE_H

#include <array>

#include "../../nurbs/curve.h"
#include "../../nurbs/surface.h"

namespace dupin::oracle {

/// Where finite differences look: around a point where the surface is smooth, else ahead of or behind it in u
/// and v.
enum class Side { central, forward, backward };

SurfaceJet surface_jet(const Surface& surface, double u, double v, Side side = Side::central);
std::array<Vec3, 4> curve_jet(const Curve3& curve, double t, Side side = Side::central);
std::array<Vec2, 4> curve_jet(const Curve2& curve, double t, Side side = Side::central);

/// d1 is up to sign. `scale` is |Suu|/a² + |Suv|/(ad) + |Svv|/d² with the lengths a, d of Su and of the part
/// of Sv across it: what a relative error of the jet turns into a curvature's error by.
struct PrincipalCurvatures {
  Vec3 n, d1;
  double k1 = 0, k2 = 0, scale = 0;
};
PrincipalCurvatures curvatures(const Surface& surface, double u, double v);

}  // namespace dupin::oracle

#endif
