// Recognition: what is a quadric, torus or revolution is found, the certificate holds, and nothing else is
// taken for one.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "../../nurbs/bezier.h"
#include "../../nurbs/invert.h"
#include "../../nurbs/recognize.h"
#include "kinds.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using testing::Random;
using testing::Sample;

constexpr Box2 kUnit{{0, 0}, {1, 1}};

/// The patch as a B-spline over [0,1]², which forgets what it came from.
BsplineSurface as_spline(const BezierPatch& patch) {
  BsplineSurface s;
  s.degree_u = patch.degree_u;
  s.degree_v = patch.degree_v;
  s.count_u = patch.degree_u + 1;
  s.count_v = patch.degree_v + 1;
  s.knots_u.assign(static_cast<std::size_t>(s.count_u), 0.0);
  s.knots_u.insert(s.knots_u.end(), static_cast<std::size_t>(s.count_u), 1.0);
  s.knots_v.assign(static_cast<std::size_t>(s.count_v), 0.0);
  s.knots_v.insert(s.knots_v.end(), static_cast<std::size_t>(s.count_v), 1.0);
  for (const Vec4& pole : patch.poles) {
    s.poles.push_back(Vec3{pole.x, pole.y, pole.z} / pole.w);
    s.weights.push_back(pole.w);
  }
  return s;
}

double distance_to(const Surface& shape, const Vec3& p, Vec2 guess) {
  const auto uv = invert(shape, p, guess);
  return uv ? distance(point_at(shape, uv->x, uv->y), p) : std::numeric_limits<double>::infinity();
}

/// Searches for points and normals that deviate by more than is certified.
void expect_certified(const Surface& original, const Box2& region, const Recognized& found) {
  constexpr int kGrid = 40;
  for (int i = 0; i <= kGrid; ++i)
    for (int j = 0; j <= kGrid; ++j) {
      const Vec2 at = region.lo + Vec2{region.size().x * i / kGrid, region.size().y * j / kGrid};
      const SurfaceJet jet = evaluate(original, at.x, at.y, 1);
      const auto uv = invert(found.surface, jet.p, {std::numbers::pi, 0});
      ASSERT_TRUE(uv);
      const SurfaceJet there = evaluate(found.surface, uv->x, uv->y, 1);
      EXPECT_LE(distance(there.p, jet.p), found.deviation + 1e-15 * length(jet.p));
      const Vec3 n = cross(jet.pu, jet.pv);
      if (i % kGrid == 0 || j % kGrid == 0 || length(n) < 1e-9) continue;  // collapsed edges
      EXPECT_GT(dot(n, cross(there.pu, there.pv)), 0);
      EXPECT_LE(length(cross(normalized(n), normalized(cross(there.pu, there.pv)))),
                found.normal_deviation + 1e-14);
    }
}

std::vector<Sample> exact_shapes(const Frame3& f) {
  return {{"plane", {Plane{f}}, {{-1, -2}, {2, 1}}},
          {"sphere", {Sphere{f, 1.7}}, {{0.3, -0.5}, {1.5, 0.9}}},
          {"sphere's cap", {Sphere{f, 1.7}}, {{0.3, 0.3}, {1.5, std::numbers::pi / 2}}},
          {"cylinder", {Cylinder{f, 1.3}}, {{0.2, -1}, {1.3, 2}}},
          {"narrow cylinder", {Cylinder{f, 0.02}}, {{0.2, -1}, {1.3, 2}}},
          {"cone", {Cone{f, 1.5, 0.4}}, {{-1, -1}, {0.5, 2}}},
          {"cone's tip", {Cone{f, 1.5, -0.4}}, {{-1, -1}, {0.5, 1.5 / std::sin(0.4)}}},
          {"torus", {Torus{f, 2.5, 0.8}}, {{0.5, 0}, {2, 1.5}}},
          {"fillet", {Torus{f, 20, 0.1}}, {{0.5, 2}, {0.8, 3.4}}}};
}

TEST(Recognize, FindsWhatASplineIs) {
  Random random(1);
  for (const bool left_handed : {false, true})
    for (const Sample& sample : exact_shapes(random.frame(left_handed))) {
      SCOPED_TRACE(sample.name);
      const auto patches = bezier_patches(sample.surface, sample.region);
      ASSERT_EQ(patches.size(), 1u);
      const Surface spline{as_spline(patches.front())};
      const auto found = recognize(spline, kUnit, 1e-7);
      ASSERT_TRUE(found);
      EXPECT_EQ(kind_name(found->surface), kind_name(sample.surface));
      // Near the tip, and for a thin torus, less than rounding cannot be certified.
      EXPECT_LE(found->deviation, sample.name == "cone's tip" ? 1e-7
                                  : sample.name == "fillet"   ? 2e-9
                                                              : 1e-11);
      EXPECT_LE(found->normal_deviation, 1e-6);
      expect_certified(spline, kUnit, *found);
    }
}

TEST(Recognize, DoesNotDependOnSizeOrPlace) {
  for (const double size : {1e-3, 1.0, 1e4}) {
    Random random(2);
    Frame3 f = random.frame();
    f.origin = Vec3{300, -200, 100} * size;
    const Surface torus{Torus{f, 2.5 * size, 0.8 * size}};
    const Surface spline{as_spline(bezier_patches(torus, {{0.5, 0}, {2, 1.5}}).front())};
    const auto found = recognize(spline, kUnit, 1e-8 * size);
    ASSERT_TRUE(found) << size;
    const Torus& got = std::get<Torus>(found->surface.geometry);
    EXPECT_NEAR(got.minor, 0.8 * size, 1e-9 * size);
    EXPECT_LE(found->deviation, 1e-10 * size);
    expect_certified(spline, kUnit, *found);
  }
}

TEST(Recognize, SeesThroughSweeps) {
  Random random(3);
  const Frame3 f = random.frame();
  const Curve3 circle{CircleOf<Vec3>{f.origin + f.x * 3.0, f.x, f.z, 0.5}},
      line{LineOf<Vec3>{f.origin + f.x * 2.0, normalized(f.z + f.x * 0.3)}};
  const Curve3 own{CircleOf<Vec3>{f.origin, f.x, f.z, 0.5}}, upright{LineOf<Vec3>{f.origin + f.x * 2.0, f.z}};
  const Box2 region{{0.2, -1}, {4, 1.2}};
  const std::vector<std::pair<Surface, std::string>> cases = {
      {{Revolution{f.origin, f.z, circle}}, "torus"},
      {{Revolution{f.origin, f.z, line}}, "cone"},
      {{Revolution{f.origin, f.z, upright}}, "cylinder"},
      {{Revolution{f.origin, f.z, own}}, "sphere"},
      {{Extrusion{circle, f.y}}, "cylinder"},
      {{Extrusion{line, f.y}}, "plane"}};
  for (const auto& [surface, kind] : cases) {
    const auto found = recognize(surface, region, 1e-7);
    ASSERT_TRUE(found) << kind;
    EXPECT_EQ(kind_name(found->surface), kind);
    EXPECT_LE(found->deviation, 1e-11) << kind;
    expect_certified(surface, region, *found);
  }
}

TEST(Recognize, CertifiesAnApproximation) {
  // A quarter of a cylinder by a polynomial cubic, which is off by 2.7e-4 of the radius.
  const double k = 0.5522847498;
  BsplineSurface s;
  s.degree_u = 3, s.degree_v = 1;
  s.count_u = 4, s.count_v = 2;
  s.knots_u = {0, 0, 0, 0, 1, 1, 1, 1};
  s.knots_v = {0, 0, 1, 1};
  for (const Vec2 p : {Vec2{1, 0}, Vec2{1, k}, Vec2{k, 1}, Vec2{0, 1}})
    for (const double z : {0.0, 2.0}) s.poles.push_back({p.x, p.y, z});
  EXPECT_FALSE(recognize({s}, kUnit, 1e-4));  // the best fit is off by half of that
  EXPECT_FALSE(recognize({s}, kUnit, 1e-3));  // and its normals by 1e-3
  // Poles with 8 digits.
  Random random(4);
  BsplineSurface rounded =
      as_spline(bezier_patches({Torus{random.frame(), 3, 1}}, {{0, 0}, {1.5, 1.2}}).front());
  for (Vec3& p : rounded.poles) p += random.point(1e-8);
  const auto found = recognize({rounded}, kUnit, 1e-7);
  ASSERT_TRUE(found);
  EXPECT_LE(found->deviation, 5e-8);
  EXPECT_GE(found->deviation, 1e-10);
  expect_certified({rounded}, kUnit, *found);
  EXPECT_FALSE(recognize({rounded}, kUnit, 1e-10));
}

TEST(Recognize, FindsOneBumpBetweenTheSamples) {
  // A flat spline of many spans, but for one pole.
  BsplineSurface s;
  s.degree_u = s.degree_v = 3;
  s.count_u = s.count_v = 60;
  for (int i = 0; i < 64; ++i) s.knots_u.push_back(std::clamp(i - 3, 0, 57));
  s.knots_v = s.knots_u;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) s.poles.push_back({i / 60.0, j / 60.0, 0});
  const Box2 whole{{0, 0}, {57, 57}};
  ASSERT_TRUE(recognize({s}, whole, 1e-6));
  s.poles[31 * 60 + 24].z = 1e-4;
  EXPECT_FALSE(recognize({s}, whole, 1e-6));
}

/// A spline profile turned by an angle, as a rational spline.
BsplineSurface lathed(const Frame3& f, double angle, bool angle_in_v) {
  Bspline3 profile;
  profile.degree = 3;
  profile.knots = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  const double rho[] = {1, 1.3, 0.8, 0.9, 1.6}, z[] = {0, 0.4, 1, 1.5, 2.1};
  for (int i = 0; i < 5; ++i) profile.poles.push_back(f.to_world({rho[i], 0, z[i]}));
  // Of the exact revolution take one arc's poles by columns of the whole profile.
  const Vec3 middle[3] = {
      {1, 0, 0}, {std::cos(angle / 2), std::sin(angle / 2), 0}, {std::cos(angle), std::sin(angle), 0}};
  const double weight[3] = {1, std::cos(angle / 2), 1};
  BsplineSurface s;
  s.degree_u = angle_in_v ? 3 : 2;
  s.degree_v = angle_in_v ? 2 : 3;
  s.count_u = angle_in_v ? 5 : 3;
  s.count_v = angle_in_v ? 3 : 5;
  const std::vector<double> arc_knots{0, 0, 0, 1, 1, 1};
  s.knots_u = angle_in_v ? profile.knots : arc_knots;
  s.knots_v = angle_in_v ? arc_knots : profile.knots;
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      const int a = angle_in_v ? j : i, b = angle_in_v ? i : j;
      const Vec3 e = middle[a] / weight[a];
      s.poles.push_back(f.to_world({rho[b] * e.x, rho[b] * e.y, z[b]}));
      s.weights.push_back(weight[a]);
    }
  return s;
}

TEST(Recognize, FindsRevolutions) {
  Random random(5);
  for (const bool angle_in_v : {false, true}) {
    const Frame3 f = random.frame();
    const Surface spline{lathed(f, 1.4, angle_in_v)};
    const Box2 region = domain(spline);
    const auto found = recognize(spline, region, 1e-7);
    ASSERT_TRUE(found);
    ASSERT_EQ(kind_name(found->surface), "revolution");
    const Revolution& got = std::get<Revolution>(found->surface.geometry);
    EXPECT_LE(length(cross(got.axis_direction, f.z)), 1e-10);
    EXPECT_LE(found->deviation, 1e-10);
    EXPECT_LE(found->normal_deviation, 1e-7);
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20; ++j) {
        const Vec2 at{region.hi.x * i / 20, region.hi.y * j / 20};
        const double along = angle_in_v ? at.x : at.y;
        const SurfaceJet jet = evaluate(spline, at.x, at.y, 1);
        // The middle of the region is half a turn from the seam; v runs as the profile did.
        const auto uv = invert(found->surface, jet.p, {std::numbers::pi, along});
        ASSERT_TRUE(uv);
        EXPECT_NEAR(uv->y, along, 1e-7);
        EXPECT_LE(std::abs(uv->x - std::numbers::pi), 0.71);
        const SurfaceJet there = evaluate(found->surface, uv->x, uv->y, 1);
        EXPECT_LE(distance(there.p, jet.p), found->deviation + 1e-14);
        EXPECT_LE(distance(normalized(cross(jet.pu, jet.pv)), normalized(cross(there.pu, there.pv))),
                  found->normal_deviation + 1e-13);
      }
  }
}

TEST(Recognize, LeavesOtherShapesAlone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    EXPECT_FALSE(recognize({testing::random_surface(random, {.rational = seed % 2 == 0})}, kUnit, 1e-6));
  }
  Random random(6);
  const Frame3 f = random.frame();
  const Curve3 ellipse{EllipseOf<Vec3>{f.origin, f.x, f.y, 1, 0.9}};
  EXPECT_FALSE(recognize({Extrusion{ellipse, f.z}}, {{0, 0}, {3, 1}}, 1e-6));
  for (const Sample& sample : testing::analytic_samples())
    EXPECT_FALSE(recognize(sample.surface, sample.region, 1e-6));
}

TEST(Recognize, OffsetsOfAnalyticSurfacesExactly) {
  Random random(7);
  for (const bool left_handed : {false, true}) {
    const Frame3 f = random.frame(left_handed);
    for (const Surface& base : std::vector<Surface>{{Plane{f}},
                                                    {Cylinder{f, 1}},
                                                    {Cone{f, 1.5, 0.4}},
                                                    {Cone{f, 1.5, -0.4}},
                                                    {Sphere{f, 1}},
                                                    {Torus{f, 3, 1}}})
      for (const double d : {-0.3, 0.4}) {
        const Surface offset{OffsetSurface{std::make_shared<const Surface>(base), d}};
        const auto found = recognize(offset, {{0, -1}, {3, 1}}, 1e-7);
        ASSERT_TRUE(found) << kind_name(base);
        EXPECT_EQ(kind_name(found->surface), kind_name(base));
        for (const Vec2 q : {Vec2{0.3, -0.8}, Vec2{2, 0.7}}) {
          const SurfaceJet a = evaluate(offset, q.x, q.y, 1), b = evaluate(found->surface, q.x, q.y, 1);
          EXPECT_LE(distance_to(found->surface, a.p, q), 1e-14);
          EXPECT_GT(dot(cross(a.pu, a.pv), cross(b.pu, b.pv)), 0);
        }
      }
    const auto cylinder = std::make_shared<const Surface>(Surface{Cylinder{f, 1}});
    EXPECT_FALSE(recognize({OffsetSurface{cylinder, left_handed ? 2.0 : -2.0}}, {{0, 0}, {1, 1}}, 1e-7));
  }
}

TEST(Recognize, GivesANarrowRegionNoSeam) {
  Random random(8);
  const Surface cylinder{Cylinder{random.frame(), 2}};
  const Surface spline{as_spline(bezier_patches(cylinder, {{-0.5, 0}, {0.7, 1}}).front())};
  const auto found = recognize(spline, kUnit, 1e-7);
  ASSERT_TRUE(found);
  for (const double u : {0.0, 0.3, 1.0}) {
    const double angle = invert(found->surface, point_at(spline, u, 0.4), {std::numbers::pi, 0})->x;
    EXPECT_LE(std::abs(angle - std::numbers::pi), 0.6 + 1e-9);
  }
}

}  // namespace
}  // namespace dupin
