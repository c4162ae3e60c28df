// Principal curvatures: against 100-digit fundamental forms and closed forms, and limits where the
// parametrisation collapses.
#include <gtest/gtest.h>

#include <numbers>

#include "kinds.h"
#include "oracle.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using Kind = Curvature::Kind;
using testing::Random;

constexpr double kQuarter = std::numbers::pi / 2;

void expect_orthonormal(const Curvature& c) {
  EXPECT_NEAR(length(c.n), 1, 1e-14);
  EXPECT_NEAR(length(c.d1), 1, 1e-14);
  EXPECT_LE(distance(cross(c.d1, c.d2), c.n), 1e-14);
  EXPECT_LE(distance(cross(c.n, c.d1), c.d2), 1e-14);
  EXPECT_GE(std::abs(c.k1), std::abs(c.k2) * (1 - 1e-14));
}

/// `digits`: how many times the rounding of the surface's own derivatives exceeds that of a jet of its size.
void compare_with_oracle(const Surface& surface, double u, double v, double digits = 1) {
  const Curvature got = principal_curvature(evaluate(surface, u, v, 2));
  const oracle::PrincipalCurvatures want = oracle::curvatures(surface, u, v);
  ASSERT_NE(got.kind, Kind::undefined);
  const double tolerance = digits * kCurvatureError * want.scale;
  EXPECT_NEAR(got.k1, want.k1, tolerance);
  EXPECT_NEAR(got.k2, want.k2, tolerance);
  EXPECT_LE(distance(got.n, want.n), digits * 1e-13);
  if (const double gap = std::abs(want.k1 - want.k2); gap > 1e3 * tolerance) {
    EXPECT_LE(length(cross(got.d1, want.d1)), 4 * tolerance / gap);
  }
  expect_orthonormal(got);
}

TEST(Curvature, AgreesWithTheFundamentalForms) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const BsplineSurface s = testing::random_surface(
        random, {.degree_u = 2 + static_cast<int>(seed % 4), .degree_v = 3, .rational = seed % 2 == 0});
    for (int i = 0; i < 4; ++i)
      compare_with_oracle({s}, testing::off_knots(random, s.knots_u, 0, 1),
                          testing::off_knots(random, s.knots_v, 0, 1), 100);
  }
  Random random(31);
  for (const testing::Sample& sample : testing::analytic_samples())
    if (sample.name.find("plane") == std::string::npos)
      compare_with_oracle(sample.surface, random.between(sample.region.lo.x, sample.region.hi.x),
                          random.between(sample.region.lo.y, sample.region.hi.y));
}

TEST(Curvature, KeepsItsDigitsFarFromTheOrigin) {
  Random random(13);
  const BsplineSurface s = testing::random_surface(random, {.rational = true, .origin = {1e6, 1e6, -1e6}});
  for (int i = 0; i < 4; ++i)
    compare_with_oracle({s}, testing::off_knots(random, s.knots_u, 0, 1),
                        testing::off_knots(random, s.knots_v, 0, 1), 100);
}

/// x, y, z as a bicubic over [0,1]² whose two partials enclose an angle of about `skew`.
BsplineSurface sheared(double skew) {
  Random random(17);
  BsplineSurface s = testing::random_surface(random, {.extra_u = 0, .extra_v = 0});
  for (Vec3& p : s.poles) p = {p.x + p.y, skew * p.y, p.z * 0.3};
  return s;
}

TEST(Curvature, SurvivesNearlyParallelPartials) {
  for (const double skew : {1e-1, 1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE("skew " + std::to_string(skew));
    const Surface surface{sheared(skew)};
    const oracle::PrincipalCurvatures want = oracle::curvatures(surface, 0.3, 0.6);
    const Curvature got = principal_curvature(evaluate(surface, 0.3, 0.6, 2));
    const double tolerance =
        10 * kCurvatureError * want.scale / skew;  // the normal itself turns by rounding / skew
    EXPECT_NEAR(got.k1, want.k1, tolerance);
    EXPECT_NEAR(got.k2, want.k2, tolerance);
    EXPECT_LE(distance(got.n, want.n), 1e-14 / skew);
    expect_orthonormal(got);
  }
}

TEST(Curvature, SeparatesNearlyEqualCurvatures) {
  // z = ½ (1 x² + (1 + gap) y²), whose curvatures at the origin differ by `gap`, seen through a turned
  // parametrisation.
  for (const double gap : {1e-3, 1e-6, 1e-9}) {
    const double c = 0.6, s = 0.8;
    SurfaceJet jet;
    jet.pu = {c, s, 0};
    jet.pv = {-s, c, 0};
    jet.puu = {0, 0, c * c + (1 + gap) * s * s};
    jet.puv = {0, 0, -c * s + (1 + gap) * c * s};
    jet.pvv = {0, 0, s * s + (1 + gap) * c * c};
    const Curvature k = principal_curvature(jet);
    EXPECT_EQ(k.kind, Kind::regular);
    EXPECT_NEAR(k.k1, 1 + gap, 2e-15);
    EXPECT_NEAR(k.k2, 1, 2e-15);
    EXPECT_LE(std::abs(k.d1.x), 1e-15 / gap + 1e-15);
  }
}

TEST(Curvature, AtAnUmbilicTakesTheBestAxis) {
  Random random(19);
  for (int i = 0; i < 20; ++i) {
    const Frame3 f = random.frame();
    const Surface sphere{Sphere{f, 2.5}}, plane{Plane{f}};
    const double u = random.between(0, 6), v = random.between(-1.4, 1.4);
    for (const Surface& surface : {sphere, plane}) {
      const Curvature c = principal_curvature(evaluate(surface, u, v, 2));
      EXPECT_EQ(c.kind, Kind::umbilic);
      EXPECT_NEAR(c.k1, is_quadric(surface) && surface.geometry.index() == 3 ? -0.4 : 0, 1e-13);
      EXPECT_EQ(c.k1, c.k2);
      // No axis projects longer than the one d1 lies along.
      double best = 0;
      for (int a = 0; a < 3; ++a) best = std::max(best, std::sqrt(1 - c.n[a] * c.n[a]));
      double along = 0;
      for (int a = 0; a < 3; ++a) along = std::max(along, c.d1[a]);
      EXPECT_NEAR(along, best, 1e-12);
      expect_orthonormal(c);
    }
  }
}

TEST(Curvature, OfATorusInClosedForm) {
  Random random(23);
  const double major = 3, minor = 0.5;
  const Surface torus{Torus{random.frame(), major, minor}};
  for (int i = 0; i < 20; ++i) {
    const double u = random.between(0, 6), v = random.between(0, 6);
    const Curvature c = principal_curvature(evaluate(torus, u, v, 2));
    EXPECT_NEAR(c.k1, -1 / minor, 1e-13);  // it bends away from its outward normal
    EXPECT_NEAR(c.k2, -std::cos(v) / (major + minor * std::cos(v)), 1e-13);
  }
}

void expect_limit(const Curvature& c, const Vec3& n, double k1, double k2, double tolerance) {
  EXPECT_EQ(c.kind, Kind::singular_limit);
  EXPECT_LE(distance(c.n, n), kLimitError);
  EXPECT_NEAR(c.k1, k1, tolerance);
  EXPECT_NEAR(c.k2, k2, tolerance);
  expect_orthonormal(c);
}

TEST(CurvatureLimit, AtThePolesOfASphere) {
  Random random(29);
  const Frame3 f = random.frame();
  const Surface sphere{Sphere{f, 2}};
  for (const double sign : {-1.0, 1.0})
    for (const double off : {0.0, 1e-12, 1e-7}) {
      const double v = sign * (kQuarter - off);
      const Vec3 n = (point_at(sphere, 0.7, v) - f.origin) / 2;
      expect_limit(principal_curvature(sphere, 0.7, v, {0.7, 0}), n, -0.5, -0.5, kLimitError);
    }
}

/// S(u,v) = (u v, v, h(u v, v)) with h = ½ (a x² + 2 b x y + c y²) + d x³: the edge v = 0 collapses into the
/// origin.
BsplineSurface collapsed(double a, double b, double c, double d) {
  // In Bézier form of degree (3, 3), by blossoming monomials: uⁱ vʲ has poles C(k,i)/C(3,i) · C(l,j)/C(3,j).
  BsplineSurface s;
  s.degree_u = s.degree_v = 3;
  s.count_u = s.count_v = 4;
  s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
  const auto monomial = [](int k, int i) {
    static const double kChoose[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
    return kChoose[k][i] / kChoose[3][i];
  };
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < 4; ++l) {
      const auto uv = [&](int i, int j) { return monomial(k, i) * monomial(l, j); };
      s.poles.push_back(
          {uv(1, 1), uv(0, 1), 0.5 * (a * uv(2, 2) + 2 * b * uv(1, 2) + c * uv(0, 2)) + d * uv(3, 3)});
    }
  return s;
}

TEST(CurvatureLimit, OnACollapsedEdge) {
  const Surface surface{collapsed(2, 0.5, -1, 0.3)};
  const double mean = 0.5, r = std::hypot(1.5, 0.5);
  for (const double u : {0.0, 0.3, 1.0}) {
    const Curvature c = principal_curvature(surface, u, 0, {0.5, 0.5});
    // Su × Sv = (v, 0, …) × (u, 1, …) points up.
    expect_limit(c, {0, 0, 1}, mean + r, mean - r, 20 * kLimitError);
    // The eigenvector of [2 .5; .5 -1].
    const Vec3 d = normalized({0.5, mean + r - 2, 0});
    EXPECT_LE(length(cross(c.d1, d)), 20 * kLimitError);
  }
}

TEST(CurvatureLimit, OnACollapsedEdgeThatIsFlat) {
  const Curvature c = principal_curvature({collapsed(0, 0, 0, 0)}, 0.2, 0, {0.5, 0.5});
  expect_limit(c, {0, 0, 1}, 0, 0, kLimitError);
}

TEST(CurvatureLimit, DoesNotExistAtAnApex) {
  Random random(37);
  const double angle = 0.5, apex = -1.5 / std::sin(angle);
  const Surface cone{Cone{random.frame(), 1.5, angle}};
  const Curvature c = principal_curvature(cone, 1, apex, {1, apex + 2});
  EXPECT_EQ(c.kind, Kind::undefined);
  EXPECT_FALSE(std::isfinite(c.k1));
  EXPECT_FALSE(is_finite(c.n));
}

TEST(CurvatureLimit, IsNotTakenWhereTheSurfaceIsRegular) {
  Random random(41);
  const BsplineSurface s = testing::random_surface(random, {.rational = true});
  for (int i = 0; i < 20; ++i) {
    const double u = random.between(0, 1), v = random.between(0, 1);
    const Curvature direct = principal_curvature(evaluate({s}, u, v, 2)),
                    by_surface = principal_curvature({s}, u, v, {0.5, 0.5});
    EXPECT_EQ(direct.k1, by_surface.k1);
    EXPECT_EQ(by_surface.kind, Kind::regular);
  }
  // Skewed everywhere is not singular either.
  EXPECT_EQ(principal_curvature({sheared(1e-6)}, 0.3, 0.6, {0.5, 0.5}).kind, Kind::regular);
}

TEST(Curvature, OfAJetWithoutANormalIsUndefined) {
  SurfaceJet jet;
  EXPECT_EQ(principal_curvature(jet).kind, Kind::undefined);
  jet.pu = {1, 0, 0};
  jet.pv = {2, 0, 0};
  EXPECT_EQ(principal_curvature(jet).kind, Kind::undefined);
}

}  // namespace
}  // namespace dupin
