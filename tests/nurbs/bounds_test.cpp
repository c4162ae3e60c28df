// Bounds of patches hold (a search for violations), and inversion finds the parameters it started from.
#include <gtest/gtest.h>

#include <numbers>

#include "../../nurbs/bounds.h"
#include "../../nurbs/invert.h"
#include "kinds.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using testing::Random;
using testing::Sample;

std::vector<Sample> rational_samples() {
  std::vector<Sample> out = testing::analytic_samples();
  for (Sample& s : testing::swept_samples(true)) out.push_back(std::move(s));
  Random random(2);
  for (int degree = 1; degree <= 6; ++degree)
    for (const bool rational : {false, true})
      out.push_back({"spline",
                     {testing::random_surface(
                         random, {.degree_u = degree, .degree_v = 7 - degree, .rational = rational})},
                     {{0, 0}, {1, 1}}});
  return out;
}

TEST(Bounds, HoldEveryPointAndNormal) {
  int bounded = 0, all = 0;
  for (const Sample& sample : rational_samples())
    for (const BezierPatch& patch : bezier_patches(sample.surface, sample.region)) {
      const Box3 box = bounding_box(patch);
      const NormalCone cone = normal_cone(patch);
      ++all;
      bounded += cone.bounded();
      for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 12; ++j) {
          // Just inside: on its border another patch's derivatives may be the ones that are evaluated.
          const double u = patch_to_surface_u(patch, 1e-9 + (1 - 2e-9) * i / 12);
          const double v = patch_to_surface_v(patch, 1e-9 + (1 - 2e-9) * j / 12);
          const SurfaceJet jet = evaluate(sample.surface, u, v, 1);
          const Vec3 slack{1e-14 * (1 + length(jet.p)), 1e-14 * (1 + length(jet.p)),
                           1e-14 * (1 + length(jet.p))};
          EXPECT_TRUE((Box3{box.lo - slack, box.hi + slack}.contains(jet.p))) << sample.name;
          if (!cone.bounded()) continue;
          const Vec3 n = normalized(cross(jet.pu, jet.pv));
          EXPECT_LE(std::atan2(length(cross(n, cone.axis)), dot(n, cone.axis)), cone.angle + 1e-12)
              << sample.name;
        }
    }
  EXPECT_GT(bounded, 0.8 * all);  // the bounds say something
}

/// Halves the patch until there are bounds; visits the pieces.
template <class Visit>
void bounded_pieces(const BezierPatch& patch, int depth, const Visit& visit) {
  const CurvatureBounds bounds = curvature_bounds(patch);
  if (bounds.bounded() || depth == 0) return visit(patch, bounds);
  for (const double s : {0.0, 0.5})
    for (const double t : {0.0, 0.5})
      bounded_pieces(subpatch(patch, s, s + 0.5, t, t + 0.5), depth - 1, visit);
}

TEST(Bounds, HoldEveryCurvature) {
  int bounded = 0, all = 0;
  for (const Sample& sample : rational_samples())
    for (const BezierPatch& whole : bezier_patches(sample.surface, sample.region))
      bounded_pieces(whole, 3, [&](const BezierPatch& patch, const CurvatureBounds& bounds) {
        ++all;
        if (!bounds.bounded()) return;
        ++bounded;
        const double slack = 1e-9 * bounds.largest();
        for (int i = 0; i <= 4; ++i)
          for (int j = 0; j <= 4; ++j) {
            const double u = patch_to_surface_u(patch, 1e-9 + (1 - 2e-9) * i / 4);
            const double v = patch_to_surface_v(patch, 1e-9 + (1 - 2e-9) * j / 4);
            const Curvature k = principal_curvature(evaluate(sample.surface, u, v, 2));
            if (k.kind == Curvature::Kind::undefined) continue;
            EXPECT_LE(std::max(k.k1, k.k2), bounds.hi + slack) << sample.name;
            EXPECT_GE(std::min(k.k1, k.k2), bounds.lo - slack) << sample.name;
          }
      });
  EXPECT_GT(bounded, 0.8 * all);  // the bounds say something
}

TEST(Bounds, OfCurvatureTightenAsPatchesAreHalved) {
  Random random(11);
  const Surface surface{testing::random_surface(random, {.extra_u = 0, .extra_v = 0, .rational = true})};
  const BezierPatch patch = bezier_patches(surface, {{0, 0}, {1, 1}}).front();
  const Curvature k = principal_curvature(evaluate(surface, 0.4, 0.6, 2));
  double before = 0;
  for (double h = 1.0 / 32; h > 1e-3; h /= 2) {
    const CurvatureBounds bounds = curvature_bounds(subpatch(patch, 0.4 - h, 0.4 + h, 0.6 - h, 0.6 + h));
    ASSERT_TRUE(bounds.bounded()) << h;
    const double excess = (bounds.hi - std::max(k.k1, k.k2)) + (std::min(k.k1, k.k2) - bounds.lo);
    if (before > 0) EXPECT_LT(excess, 0.6 * before);
    before = excess;
  }
  const Surface sphere{Sphere{{}, 2}};
  const CurvatureBounds bounds = curvature_bounds(bezier_patches(sphere, {{0, -0.05}, {0.1, 0.05}}).front());
  EXPECT_NEAR(bounds.lo, -0.5, 0.1);
  EXPECT_NEAR(bounds.hi, -0.5, 0.1);
}

TEST(Bounds, OfCurvatureSayNothingAtASingularPoint) {
  const Surface sphere{Sphere{{}, 1}};
  EXPECT_FALSE(
      curvature_bounds(bezier_patches(sphere, {{0, 1.2}, {1, std::numbers::pi / 2}}).front()).bounded());
}

TEST(Bounds, ConesAreTightOnSmallPatches) {
  const Surface sphere{Sphere{{}, 1}};
  const BezierPatch patch = bezier_patches(sphere, {{0, -0.1}, {0.2, 0.1}}).front();
  const NormalCone cone = normal_cone(patch);
  EXPECT_LE(cone.angle, 0.16);  // half the diagonal is 0.141
  EXPECT_GE(cone.angle, 0.14);
  EXPECT_TRUE(may_face(cone, cone.axis, 0));
  EXPECT_FALSE(may_face(cone, -cone.axis, 0));
  EXPECT_EQ(normal_cone(bezier_patches({Plane{}}, {{0, 0}, {1, 1}}).front()).axis, (Vec3{0, 0, 1}));
}

TEST(Bounds, ConesLookPastCollapsedEdges) {
  const Surface sphere{Sphere{{}, 1}};
  const BezierPatch cap = bezier_patches(sphere, {{0, 1.2}, {1, std::numbers::pi / 2}}).front();
  const NormalCone cone = normal_cone(cap);
  EXPECT_TRUE(cone.bounded());
  EXPECT_LE(std::acos(dot(cone.axis, {0, 0, 1})), cone.angle);
}

TEST(Bounds, AreInfiniteForWeightsThatAreNotPositive) {
  BezierPatch patch = bezier_patches({Sphere{{}, 1}}, {{0, 0}, {1, 1}}).front();
  patch.poles[4].w = 0;
  EXPECT_TRUE(std::isinf(bounding_box(patch).hi.x));
  EXPECT_FALSE(normal_cone(patch).bounded());
}

TEST(Bounds, HoldCurves) {
  Random random(9);
  const Curve3 curve{testing::random_curve(random, 4, 5, true, false)};
  for (const BezierCurve3& piece : bezier_curves(curve, 0, 1)) {
    const Box3 box = bounding_box(piece);
    for (int i = 0; i <= 50; ++i) {
      const Vec3 p = point_at(curve, piece.t0 + (piece.t1 - piece.t0) * i / 50), slack{1e-14, 1e-14, 1e-14};
      EXPECT_TRUE((Box3{box.lo - slack, box.hi + slack}.contains(p)));
    }
  }
}

TEST(Invert, FindsTheParametersOfAPoint) {
  Random random(11);
  std::vector<Sample> samples = testing::analytic_samples();
  for (Sample& s : testing::swept_samples(false)) samples.push_back(std::move(s));
  for (Sample& s : testing::offset_samples()) samples.push_back(std::move(s));
  samples.push_back({"spline", {testing::random_surface(random, {.rational = true})}, {{0, 0}, {1, 1}}});
  for (const Sample& sample : samples)
    for (int i = 0; i < 10; ++i) {
      const Vec2 size = sample.region.size();
      const Vec2 at = sample.region.lo + Vec2{size.x * random.between(0, 1), size.y * random.between(0, 1)};
      const Vec2 guess =
          at + Vec2{size.x * random.between(-0.03, 0.03), size.y * random.between(-0.03, 0.03)};
      const auto found = invert(sample.surface, point_at(sample.surface, at.x, at.y), guess);
      ASSERT_TRUE(found) << sample.name;
      EXPECT_LE(length(*found - at), 1e-9) << sample.name << " at " << at.x << ", " << at.y;
    }
}

TEST(Invert, ProjectsPointsBesideTheSurface) {
  Random random(12);
  const Surface spline{testing::random_surface(random, {.degree_u = 3, .degree_v = 3})};
  for (int i = 0; i < 20; ++i) {
    const Vec2 at{random.between(0.1, 0.9), random.between(0.1, 0.9)};
    const SurfaceJet jet = evaluate(spline, at.x, at.y, 1);
    const Vec3 p = jet.p + normalized(cross(jet.pu, jet.pv)) * random.between(-0.01, 0.01);
    const auto found = invert(spline, p, at + Vec2{0.02, -0.02});
    ASSERT_TRUE(found);
    EXPECT_LE(length(*found - at), 1e-6);
  }
  // Beyond the border the nearest point is on it.
  const SurfaceJet edge = evaluate(spline, 1, 0.5, 1);
  const auto found = invert(spline, edge.p + normalized(edge.pu) * 0.01, {0.95, 0.5});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->x, 1);
}

TEST(Invert, UnwrapsAnglesTowardsTheGuess) {
  const Surface torus{Torus{{}, 3, 1}};
  const Vec3 p = point_at(torus, 1, 2);
  const auto found = invert(torus, p, {1 + 4 * std::numbers::pi, 2 - 2 * std::numbers::pi});
  EXPECT_NEAR(found->x, 1 + 4 * std::numbers::pi, 1e-14);
  EXPECT_NEAR(found->y, 2 - 2 * std::numbers::pi, 1e-14);
  EXPECT_EQ(invert({Sphere{{}, 2}}, {0, 0, 2}, {0.77, 1})->x, 0.77);
}

TEST(Invert, FindsPointsOfARevolutionFromItsProfileAlone) {
  // The profile starts on the axis, at the origin of space; the azimuth is not guessed.
  Bspline3 profile;
  profile.degree = 2;
  profile.knots = {0, 0, 0, 1, 1, 1};
  profile.poles = {{0, 0, 0}, {2, 0, 0}, {2, 0, 3}};
  const Surface bowl{Revolution{{}, {0, 0, 1}, {profile}}};
  for (const double u : {0.1, 1.9, 3.0, 5.5})
    for (const double v : {0.0, 1e-9, 0.3, 1.0}) {
      const auto found = invert(bowl, point_at(bowl, u, v), {std::numbers::pi, v + (v == 0 ? 0 : 0.01)});
      ASSERT_TRUE(found);
      EXPECT_LE(distance(point_at(bowl, found->x, found->y), point_at(bowl, u, v)), 1e-13) << u << ", " << v;
    }
}

TEST(Invert, SaysWhenItDidNotConverge) {
  // Nothing is nearest on a surface that is not finite.
  BsplineSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  s.poles.assign(4, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_FALSE(invert({s}, {1, 2, 3}, {0.5, 0.5}));
}

}  // namespace
}  // namespace dupin
