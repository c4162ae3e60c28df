// Curves in the plane and in space, exact: lines, conics, B-splines, offsets.
//
// One template for both dimensions. Parametrisations are those of ISO 10303-42 (and of OCCT), so that
// parameter ranges and pcurves of files mean what they say:
//   line       O + t·X                                  hyperbola  O + a·cosh t·X + b·sinh t·Y
//   circle     O + r·(cos t·X + sin t·Y)                parabola   O + (t²/4f)·X + t·Y
//   ellipse    O + a·cos t·X + b·sin t·Y                B-spline   Σ Nᵢ(t) wᵢ Pᵢ / Σ Nᵢ(t) wᵢ
// A trimmed curve is a curve and a range [t0, t1], which whoever uses the curve holds.
#ifndef DUPIN_NURBS_CURVE_H
#define DUPIN_NURBS_CURVE_H

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "../core/status.h"
#include "../core/vec.h"

namespace dupin {

/// Position and derivatives of a curve: d[0] is the point, d[k] the k-th derivative; d[k] above the order
/// that was asked for are zero.
template <class V>
using CurveJet = std::array<V, 4>;

template <class V>
struct LineOf {
  V origin, direction;  ///< the direction's length is the speed
};
template <class V>
struct CircleOf {
  V center, x, y;  ///< x, y unit and perpendicular
  double radius = 0;
};
template <class V>
struct EllipseOf {
  V center, x, y;
  double major = 0, minor = 0;  ///< along x and y
};
template <class V>
struct ParabolaOf {
  V vertex, x, y;
  double focal = 0;
};
template <class V>
struct HyperbolaOf {
  V center, x, y;
  double major = 0, minor = 0;
};
template <class V>
struct BsplineOf {
  int degree = 0;
  std::vector<double> knots;  ///< full, see knots.h
  std::vector<V> poles;
  std::vector<double> weights;  ///< empty: all 1
  bool periodic = false;        ///< closes smoothly with the period knots[n] - knots[degree]
};
template <class V>
struct CurveOf;
/// base(t) + distance · normal(t): in the plane the tangent turned clockwise (OCCT's side); in space
/// T × reference, normalised.
template <class V>
struct OffsetCurveOf {
  std::shared_ptr<const CurveOf<V>> base;
  double distance = 0;
  Vec3 reference;  ///< used in space only
};

template <class V>
struct CurveOf {
  std::variant<LineOf<V>, CircleOf<V>, EllipseOf<V>, ParabolaOf<V>, HyperbolaOf<V>, BsplineOf<V>,
               OffsetCurveOf<V>>
      geometry;
};

using Curve2 = CurveOf<Vec2>;
using Curve3 = CurveOf<Vec3>;
using Bspline2 = BsplineOf<Vec2>;
using Bspline3 = BsplineOf<Vec3>;

/// Coordinates, radii and knots beyond this, and weights beyond this or below its reciprocal, are refused:
/// their products would leave the range of a double.
inline constexpr double kMaxCoordinate = 1e60, kMaxWeight = 1e30;

/// Ok, or what is wrong with it, with the value and its index (see surface.h).
Status check(const Curve2& curve);
Status check(const Curve3& curve);

/// Position and derivatives to `order` (0 … 3). A B-spline is evaluated at t clamped to its domain, or
/// wrapped into it if periodic. Where an offset's base has no tangent the result is not finite.
CurveJet<Vec2> evaluate(const Curve2& curve, double t, int order);
CurveJet<Vec3> evaluate(const Curve3& curve, double t, int order);
inline Vec2 point_at(const Curve2& curve, double t) {
  return evaluate(curve, t, 0)[0];
}
inline Vec3 point_at(const Curve3& curve, double t) {
  return evaluate(curve, t, 0)[0];
}

struct ParameterRange {
  double lo = 0, hi = 0;
};
/// The natural parameter domain; infinite where the curve is.
ParameterRange domain(const Curve2& curve);
ParameterRange domain(const Curve3& curve);
/// The period of a circle, an ellipse or a periodic B-spline (or an offset of one); else 0.
double period(const Curve2& curve);
double period(const Curve3& curve);

/// Parameters strictly inside (t0, t1) at which the curve is less than `continuity` times continuously
/// differentiable, judged by its knots' multiplicities; ascending.
std::vector<double> breaks(const Curve2& curve, double t0, double t1, int continuity);
std::vector<double> breaks(const Curve3& curve, double t0, double t1, int continuity);

}  // namespace dupin

#endif
