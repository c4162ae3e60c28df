#include "../../cad_import/reader/curve_fit.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "../../cad_import/reader/curve_tools.h"

namespace dupin::reader {
namespace {

constexpr double kPi = std::numbers::pi;

double largest_miss(const Surface& surface, const Curve2& pcurve, const Curve3& curve, double t0, double t1) {
  double worst = 0;
  for (int i = 0; i <= 997; ++i) {
    const double t = t0 + (t1 - t0) * i / 997;
    const Vec2 q = point_at(pcurve, t);
    worst = std::max(worst, distance(point_at(surface, q.x, q.y), point_at(curve, t)));
  }
  return worst;
}

// A spline that winds around a cylinder of radius 2 more than once: points of a helix, interpolated linearly
// in between by the poles' polygon, so it does not lie on the cylinder exactly.
Curve3 coil(int turns, int poles) {
  Bspline3 s;
  s.degree = 3;
  for (int i = 0; i < poles; ++i) {
    const double a = 2 * kPi * turns * i / (poles - 1);
    s.poles.push_back({2 * std::cos(a), 2 * std::sin(a), 0.3 * a});
  }
  s.knots.assign(3, 0);
  for (int i = 0; i <= poles - 3; ++i) s.knots.push_back(i / static_cast<double>(poles - 3));
  s.knots.insert(s.knots.end(), 3, 1);
  return {s};
}

TEST(CurveFit, KeepsItsTurnsAroundACylinder) {
  const Surface cylinder{Cylinder{{}, 2}};
  const Curve3 curve = coil(3, 60);
  const auto fit = fit_pcurve(cylinder, {{0, -1}, {2 * kPi, 10}}, curve, 0, 1, 1e-8);
  ASSERT_TRUE(fit);
  double own = 0;
  for (int i = 0; i <= 997; ++i) {
    const Vec3 p = point_at(curve, i / 997.0);
    own = std::max(own, std::abs(std::hypot(p.x, p.y) - 2));
  }
  EXPECT_LT(largest_miss(cylinder, *fit, curve, 0, 1), 1.01 * own + 1e-6);
  EXPECT_NEAR(point_at(*fit, 1).x - point_at(*fit, 0).x, 6 * kPi, 1e-6);
}

TEST(CurveFit, CirclesOnASphereNearItsPole) {
  const Surface sphere{Sphere{{}, 3}};
  for (const double tilt : {0.0, 0.3, 1.2, kPi / 2 - 0.02}) {  // the last one passes the pole closely
    const Vec3 x{std::cos(tilt), 0, std::sin(tilt)};
    const Curve3 circle{CircleOf<Vec3>{{0, 0, 0}, x, {0, 1, 0}, 3}};
    const auto fit = fit_pcurve(sphere, {{0, -kPi / 2}, {2 * kPi, kPi / 2}}, circle, 0.4, 2.9, 1e-8);
    ASSERT_TRUE(fit) << tilt;
    EXPECT_LT(largest_miss(sphere, *fit, circle, 0.4, 2.9), 1e-6) << tilt;
  }
}

TEST(CurveFit, AProjectionFindsThePointItCameFrom) {
  BsplineSurface s;
  s.degree_u = s.degree_v = 3;
  s.count_u = s.count_v = 6;
  s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      s.poles.push_back({i * 1.0, j * 1.0, 0.5 * std::sin(i * 1.3) * std::cos(j * 0.9)});
  const Surface surface{s};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 3);
  for (int i = 0; i < 200; ++i) {
    const Vec2 q{i == 0 ? 0 : unit(random), i < 2 ? 3 : unit(random)};
    const Vec2 found = project(surface, domain(surface), point_at(surface, q.x, q.y), nullptr);
    EXPECT_LT(length(found - q), 1e-7) << q.x << " " << q.y;
  }
}

TEST(CurveFit, TheCurveOfAPcurve) {
  const Surface torus{Torus{{}, 5, 2}};
  const Curve2 pcurve{Bspline2{2, {0, 0, 0, 1, 1, 1}, {{0, 0}, {3, 1}, {4, 5}}, {}, false}};
  const auto fit = fit_curve(torus, pcurve, 0, 1, 1e-8);
  ASSERT_TRUE(fit);
  EXPECT_LT(largest_miss(torus, pcurve, *fit, 0, 1), 1e-7);
}

TEST(CurveTools, EveryKindLiesInItsPlaneExactly) {
  Frame3 plane{{1, 2, 3}, normalized(Vec3{1, 1, 0}), normalized(Vec3{-1, 1, 1}), {}};
  plane.z = normalized(cross(plane.x, plane.y));
  const Vec3 x = normalized(plane.x + plane.y * 0.5), y = cross(plane.z, x), c = plane.origin + plane.x * 2;
  const Curve3 curves[] = {Curve3{LineOf<Vec3>{c, x * 3}},
                           Curve3{CircleOf<Vec3>{c, x, y, 2}},
                           Curve3{CircleOf<Vec3>{c, x, -y, 2}},
                           Curve3{EllipseOf<Vec3>{c, x, y, 3, 1}},
                           Curve3{ParabolaOf<Vec3>{c, x, -y, 0.7}},
                           Curve3{HyperbolaOf<Vec3>{c, x, y, 2, 1}},
                           Curve3{Bspline3{2, {0, 0, 0, 1, 1, 1}, {c, c + x, c + y}, {1, 0.5, 2}, false}}};
  const Surface surface{Plane{plane}};
  for (const Curve3& curve : curves) {
    const auto flat = in_plane(curve, plane);
    ASSERT_TRUE(flat) << curve.geometry.index();
    EXPECT_LT(largest_miss(surface, *flat, curve, 0, 1), 1e-13) << curve.geometry.index();
  }
  EXPECT_FALSE(in_plane(Curve3{CircleOf<Vec3>{c, x, plane.z, 2}}, plane)) << "a circle on edge is no circle";
}

TEST(CurveTools, MovedParametersMeanTheSamePoints) {
  const Curve2 spline{Bspline2{2, {0, 0, 0, 1, 1, 1}, {{0, 0}, {3, 1}, {4, 5}}, {}, false}};
  const Curve2 line{LineOf<Vec2>{{1, 2}, {3, 4}}}, circle{CircleOf<Vec2>{{1, 2}, {1, 0}, {0, -1}, 2}};
  for (const Curve2& curve : {spline, line}) {
    const auto moved = reparametrized(curve, 0.2, 0.5);
    ASSERT_TRUE(moved);
    for (const double t : {0.0, 0.3, 1.6})
      EXPECT_LT(length(point_at(*moved, t) - point_at(curve, 0.2 + 0.5 * t)), 1e-14);
  }
  const auto turned = reparametrized(circle, 0.7, 1);
  ASSERT_TRUE(turned);
  EXPECT_LT(length(point_at(*turned, 0.4) - point_at(circle, 1.1)), 1e-14);
  EXPECT_FALSE(reparametrized(circle, 0.7, 2));
}

TEST(CurveTools, BoundsHoldTheCurveTightly) {
  const Curve2 arc{CircleOf<Vec2>{{1, 2}, {1, 0}, {0, 1}, 2}};
  const Box2 box = bounds(arc, 0.1, 3.5);
  EXPECT_NEAR(box.hi.y, 4, 1e-12);
  EXPECT_NEAR(box.lo.x, -1, 1e-12);
  EXPECT_NEAR(box.hi.x, 1 + 2 * std::cos(0.1), 1e-12);
  EXPECT_NEAR(box.lo.y, 2 + 2 * std::sin(3.5), 1e-12);
}

}  // namespace
}  // namespace dupin::reader
