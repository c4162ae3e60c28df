#include "curve_tools.h"

#include <algorithm>

#include "extrema.h"

namespace dupin::reader {
namespace {

template <class V, class F>
void for_each_position(CurveOf<V>& curve, F&& move) {
  std::visit(
      [&]<class T>(T& c) {
        if constexpr (std::is_same_v<T, LineOf<V>>)
          move(c.origin);
        else if constexpr (std::is_same_v<T, ParabolaOf<V>>)
          move(c.vertex);
        else if constexpr (std::is_same_v<T, BsplineOf<V>>)
          std::for_each(c.poles.begin(), c.poles.end(), move);
        else if constexpr (std::is_same_v<T, OffsetCurveOf<V>>) {
          auto base = std::make_shared<CurveOf<V>>(*c.base);
          for_each_position(*base, move);
          c.base = std::move(base);
        } else
          move(c.center);
      },
      curve.geometry);
}

// cos and sin of a turn by `a` applied to a conic's axes: center + r(cos(a+t)·x + sin(a+t)·y).
template <class C>
Curve2 turned(C conic, double a) {
  const Vec2 x = conic.x, y = conic.y;
  conic.x = x * std::cos(a) + y * std::sin(a);
  conic.y = y * std::cos(a) - x * std::sin(a);
  return {conic};
}

constexpr double kSameSpeed = 1e-12;

// In-plane axes of a conic; none if either leaves the plane by more than an angle that moves it visibly.
constexpr double kTilt = 1e-9;

struct PlanarAxes {
  Vec2 center, x, y;
};
std::optional<PlanarAxes> planar_axes(const Frame3& plane, const Vec3& center, const Vec3& x, const Vec3& y) {
  if (std::abs(dot(x, plane.z)) > kTilt || std::abs(dot(y, plane.z)) > kTilt) return std::nullopt;
  const Vec3 c = plane.to_local(center);
  const Vec2 a{dot(x, plane.x), dot(x, plane.y)}, b{dot(y, plane.x), dot(y, plane.y)};
  const Vec2 unit = a / length(a), across{-unit.y, unit.x};
  return PlanarAxes{{c.x, c.y}, unit, cross(a, b) > 0 ? across : -across};
}

}  // namespace

void translate(Curve2& curve, Vec2 by) {
  for_each_position(curve, [&](Vec2& p) { p += by; });
}

std::optional<Curve2> reparametrized(const Curve2& curve, double a, double b) {
  if (a == 0 && b == 1) return curve;
  if (const auto* line = std::get_if<LineOf<Vec2>>(&curve.geometry))
    return Curve2{LineOf<Vec2>{line->origin + line->direction * a, line->direction * b}};
  if (const auto* spline = std::get_if<Bspline2>(&curve.geometry)) {
    Bspline2 moved = *spline;
    for (double& k : moved.knots) k = (k - a) / b;
    return Curve2{std::move(moved)};
  }
  if (std::abs(b - 1) > kSameSpeed) return std::nullopt;
  if (const auto* circle = std::get_if<CircleOf<Vec2>>(&curve.geometry)) return turned(*circle, a);
  return std::nullopt;
}

std::optional<Curve2> in_plane(const Curve3& curve, const Frame3& plane) {
  const auto point = [&](const Vec3& p) {
    const Vec3 q = plane.to_local(p);
    return Vec2{q.x, q.y};
  };
  if (const auto* line = std::get_if<LineOf<Vec3>>(&curve.geometry))
    return Curve2{
        LineOf<Vec2>{point(line->origin), {dot(line->direction, plane.x), dot(line->direction, plane.y)}}};
  if (const auto* spline = std::get_if<Bspline3>(&curve.geometry)) {
    Bspline2 flat{spline->degree, spline->knots, {}, spline->weights, spline->periodic};
    flat.poles.reserve(spline->poles.size());
    for (const Vec3& p : spline->poles) flat.poles.push_back(point(p));
    return Curve2{std::move(flat)};
  }
  if (const auto* c = std::get_if<CircleOf<Vec3>>(&curve.geometry))
    if (const auto a = planar_axes(plane, c->center, c->x, c->y))
      return Curve2{CircleOf<Vec2>{a->center, a->x, a->y, c->radius}};
  if (const auto* c = std::get_if<EllipseOf<Vec3>>(&curve.geometry))
    if (const auto a = planar_axes(plane, c->center, c->x, c->y))
      return Curve2{EllipseOf<Vec2>{a->center, a->x, a->y, c->major, c->minor}};
  if (const auto* c = std::get_if<ParabolaOf<Vec3>>(&curve.geometry))
    if (const auto a = planar_axes(plane, c->vertex, c->x, c->y))
      return Curve2{ParabolaOf<Vec2>{a->center, a->x, a->y, c->focal}};
  if (const auto* c = std::get_if<HyperbolaOf<Vec3>>(&curve.geometry))
    if (const auto a = planar_axes(plane, c->center, c->x, c->y))
      return Curve2{HyperbolaOf<Vec2>{a->center, a->x, a->y, c->major, c->minor}};
  return std::nullopt;
}

Curve2 segment(Vec2 a, Vec2 b, double t0, double t1) {
  const Vec2 speed = (b - a) / (t1 - t0);
  return {LineOf<Vec2>{a - speed * t0, speed}};
}

Box2 bounds(const Curve2& curve, double t0, double t1) {
  Box2 box;
  for_each_extremum<2>(curve, t0, t1, [&](Vec2 p) { box.add(p); });
  return box;
}

}  // namespace dupin::reader
