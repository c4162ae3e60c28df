// The ray caster's crossings, held against 100-digit arithmetic and against points known to be on the
// surface.
#include "../../exact/surface_caster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>

#include "../nurbs/oracle.h"
#include "../nurbs/random_geometry.h"

namespace dupin::exact {
namespace {

using testing::Random;
using Real = boost::multiprecision::cpp_bin_float_100;
constexpr double kPi = std::numbers::pi;

std::vector<Crossing> crossings(const SurfaceCaster& caster, const Line& line) {
  std::vector<Crossing> found;
  for (std::size_t cell = 0; cell < caster.boxes().size(); ++cell) caster.meet(cell, line, found);
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  return found;
}

/// How far the 100-digit surface at the crossing's parameters lies from the line's point at its t.
double distance_from_oracle(const Surface& surface, const Line& line, const Crossing& crossing) {
  const SurfaceJet jet = oracle::surface_jet(surface, crossing.uv.x, crossing.uv.y);
  return distance(jet.p, line.origin + line.direction * crossing.t);
}

/// A line through S(uv) from afar, not along the surface there.
Line line_through(Random& random, const Surface& surface, Vec2 uv) {
  const SurfaceJet jet = evaluate(surface, uv.x, uv.y, 1);
  const Vec3 n = normalized(cross(jet.pu, jet.pv));
  Vec3 direction = random.direction();
  while (std::abs(dot(direction, n)) < 0.05) direction = random.direction();
  return {jet.p - direction * random.between(2, 20), direction * random.between(0.5, 2)};
}

/// Every point of the surface is found along a line through it, and all that is found is true.
void expect_points_found(const Surface& surface, const Box2& region, Random& random, int trials,
                         double tolerance) {
  const auto caster = make_caster(surface, region);
  for (int trial = 0; trial < trials; ++trial) {
    const Vec2 uv{random.between(region.lo.x, region.hi.x), random.between(region.lo.y, region.hi.y)};
    const Line line = line_through(random, surface, uv);
    const Vec3 p = point_at(surface, uv.x, uv.y);
    bool found = false;
    for (const Crossing& crossing : crossings(*caster, line)) {
      EXPECT_LT(distance_from_oracle(surface, line, crossing), tolerance) << kind_name(surface) << trial;
      found = found || distance(line.origin + line.direction * crossing.t, p) < 10 * tolerance;
    }
    EXPECT_TRUE(found) << kind_name(surface) << " trial " << trial << " at " << uv.x << ", " << uv.y;
  }
}

struct Case {
  Surface surface;
  Box2 region;
};
std::vector<Case> analytic_cases(Random& random) {
  const auto frame = [&] { return random.frame(random.integer(0, 1) == 1); };
  return {{{Plane{frame()}}, {{-1, -2}, {2, 1}}},
          {{Cylinder{frame(), 0.7}}, {{0, -1}, {2 * kPi, 2}}},
          {{Cone{frame(), 0.5, 0.4}}, {{0, -3}, {2 * kPi, 2}}},  // both nappes
          {{Sphere{frame(), 1.3}}, {{0, -kPi / 2}, {2 * kPi, kPi / 2}}},
          {{Torus{frame(), 1.5, 0.4}}, {{0, 0}, {2 * kPi, 2 * kPi}}},
          {{Torus{frame(), 0.5, 0.9}}, {{0, 0}, {2 * kPi, 2 * kPi}}}};  // through its axis
}

TEST(SurfaceCaster, AnalyticSurfacesAreMetWhereTheirPointsAre) {
  for (int seed = 0; seed < 4; ++seed) {
    Random random(seed);
    for (const Case& c : analytic_cases(random)) expect_points_found(c.surface, c.region, random, 40, 1e-13);
  }
}

/// The torus's equation along the line, to 100 digits.
Real torus_value(const Torus& torus, const Line& line, const Real& t) {
  const Vec3 o = torus.frame.to_local(line.origin);
  const Vec3 d{dot(line.direction, torus.frame.x), dot(line.direction, torus.frame.y),
               dot(line.direction, torus.frame.z)};
  const Real x = o.x + t * d.x, y = o.y + t * d.y, z = o.z + t * d.z, r = torus.minor, major = torus.major;
  const Real s = x * x + y * y + z * z + major * major - r * r;
  return s * s - 4 * major * major * (x * x + y * y);
}

TEST(SurfaceCaster, ATorusIsMetWhereItsQuarticChangesSign) {
  Random random(11);
  const Torus torus{random.frame(), 1.5, 0.45};
  const Surface surface{torus};
  const auto caster = make_caster(surface, {{0, 0}, {2 * kPi, 2 * kPi}});
  int met = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 target = torus.frame.origin + random.point(1.5);
    const Vec3 direction = random.direction();
    const Line line{target - direction * 10, direction};
    // Sign changes of the quartic on a fine grid, which no two roots share but by chance.
    std::vector<double> changes;
    const int steps = 1000;
    bool before = torus_value(torus, line, 5) > 0;
    for (int i = 1; i <= steps; ++i) {
      const double t = 5 + 10.0 * i / steps;
      const bool now = torus_value(torus, line, t) > 0;
      if (now != before) changes.push_back(t);
      before = now;
    }
    const auto found = crossings(*caster, line);
    ASSERT_GE(found.size(), changes.size()) << trial;
    ASSERT_EQ((found.size() - changes.size()) % 2, 0U) << trial;  // two within one step
    met += static_cast<int>(found.size());
    for (const Crossing& crossing : found) {
      const Real step = 1e-12;
      EXPECT_NE(torus_value(torus, line, Real(crossing.t) - step) > 0,
                torus_value(torus, line, Real(crossing.t) + step) > 0);
    }
  }
  EXPECT_GT(met, 80);
}

TEST(SurfaceCaster, SplinesAreMetWhereTheirPointsAre) {
  for (int seed = 0; seed < 10; ++seed) {
    Random random(100 + seed);
    testing::SplineOptions options;
    options.degree_u = random.integer(1, 7);
    options.degree_v = random.integer(1, 7);
    options.rational = seed % 2 == 1;
    options.repeat_knots = seed % 3 == 0;
    options.periodic_u = seed % 5 == 4;
    const Surface surface{random_surface(random, options)};
    expect_points_found(surface, domain(surface), random, 12, 1e-12);
  }
}

TEST(SurfaceCaster, SweptSurfacesAreMetWhereTheirPointsAre) {
  Random random(7);
  const Bspline3 profile = random_curve(random, 3, 4, true, false, {2.5, 0, 0});
  const Surface turned{Revolution{{0, 0, 0}, {0, 0, 1}, {profile}}}, moved{Extrusion{{profile}, {0, 0, 1}}};
  expect_points_found(turned, {{0, 0}, {2 * kPi, 1}}, random, 30, 1e-12);
  expect_points_found(moved, {{0, -1}, {1, 2}}, random, 30, 1e-12);
}

TEST(SurfaceCaster, OffsetsAreMetWhereTheirPointsAre) {
  Random random(8);
  const auto base = std::make_shared<const Surface>(Surface{random_surface(random, {})});
  const Surface surface{OffsetSurface{base, 0.05}};
  EXPECT_FALSE(make_caster(surface, domain(surface))->complete());
  expect_points_found(surface, domain(surface), random, 8, 1e-10);
}

TEST(SurfaceCaster, ACollapsedEdgeIsMetBesideItsPole) {
  // The top row of poles is one point.
  Random random(9);
  testing::SplineOptions options;
  BsplineSurface spline = random_surface(random, options);
  for (int i = 0; i < spline.count_u; ++i)
    spline.poles[static_cast<std::size_t>(i * spline.count_v)] = spline.poles[0];
  const Surface surface{spline};
  const auto caster = make_caster(surface, domain(surface));
  for (const double v : {1e-2, 1e-3, 1e-4}) {
    const Vec3 p = point_at(surface, 0.37, v), direction = normalized(Vec3{0.1, 0.2, -1});
    const Line line{p - direction * 5, direction};
    const auto found = crossings(*caster, line);
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Crossing& c) {
      return distance(line.origin + line.direction * c.t, p) < 1e-10;
    })) << v;
  }
}

TEST(SurfaceCaster, FarFromTheOriginNothingIsLost) {
  Random random(10);
  testing::SplineOptions options;
  options.origin = {1e7, -2e7, 5e6};
  const Surface surface{random_surface(random, options)};
  expect_points_found(surface, domain(surface), random, 20, 2e-8);  // 8 ulp of the coordinates
}

TEST(SurfaceCaster, ALineInASurfaceEndsTheSearch) {
  const Bspline3 profile{1, {0, 0, 1, 1}, {{0, 0, 0}, {1, 0.5, 0}}, {}, false};
  const Surface wall{Extrusion{{profile}, {0, 0, 1}}};
  const auto caster = make_caster(wall, {{0, 0}, {1, 1}});
  EXPECT_LT(crossings(*caster, {{0.5, 0.25, 5}, {0, 0, -1}}).size(), 10000U);  // and soon
}

}  // namespace
}  // namespace dupin::exact
