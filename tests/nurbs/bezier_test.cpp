// Bézier patches and curves reproduce what they were cut from.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "../../nurbs/bezier.h"
#include "kinds.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using testing::Random;
using testing::Sample;

std::vector<Sample> all_samples() {
  std::vector<Sample> out = testing::analytic_samples();
  for (Sample& s : testing::swept_samples(true)) out.push_back(std::move(s));
  Random random(2);
  for (const bool rational : {false, true}) {
    out.push_back({"spline",
                   {testing::random_surface(
                       random, {.degree_u = 4, .degree_v = 2, .rational = rational, .repeat_knots = true})},
                   {{0, 0}, {1, 1}}});
    out.push_back({"part of a spline",
                   {testing::random_surface(random, {.degree_u = 3, .degree_v = 11, .rational = rational})},
                   {{0.13, 0.2}, {0.77, 0.21}}});
    out.push_back(
        {"across the seam of a spline",
         {testing::random_surface(random, {.extra_u = 4, .rational = rational, .periodic_u = true})},
         {{-0.4, 0}, {0.5, 1}}});
  }
  return out;
}

void expect_on_surface(const Sample& sample, const BezierPatch& patch, double s, double t) {
  const double u = patch_to_surface_u(patch, s), v = patch_to_surface_v(patch, t);
  EXPECT_LE(distance(point_at(patch, s, t), point_at(sample.surface, u, v)), kBezierError * 10)
      << sample.name << " at " << u << ", " << v;
  EXPECT_NEAR(surface_to_patch_u(patch, u), s, 1e-12) << sample.name;
  EXPECT_NEAR(surface_to_patch_v(patch, v), t, 1e-12) << sample.name;
}

TEST(BezierPatches, ReproduceEveryKind) {
  Random random(3);
  for (const Sample& sample : all_samples()) {
    const std::vector<BezierPatch> patches = bezier_patches(sample.surface, sample.region);
    ASSERT_FALSE(patches.empty()) << sample.name;
    for (const BezierPatch& patch : patches) {
      for (int i = 0; i < 6; ++i)
        expect_on_surface(sample, patch, random.between(0, 1), random.between(0, 1));
      for (const double s : {0.0, 0.5, 1.0}) expect_on_surface(sample, patch, s, 1 - s);
    }
  }
}

TEST(BezierPatches, TileTheRegion) {
  for (const Sample& sample : all_samples()) {
    double area = 0;
    Box2 whole;
    for (const BezierPatch& patch : bezier_patches(sample.surface, sample.region)) {
      const Vec2 size = patch.domain.size();
      EXPECT_GT(size.x, 0);
      EXPECT_GT(size.y, 0);
      if (patch.u_is_angle) {
        EXPECT_LE(size.x, std::numbers::pi / 2 + 1e-8);
      }
      if (patch.v_is_angle) {
        EXPECT_LE(size.y, std::numbers::pi / 2 + 1e-8);
      }
      area += size.x * size.y;
      whole.add(patch.domain.lo);
      whole.add(patch.domain.hi);
    }
    EXPECT_EQ(whole.lo, sample.region.lo) << sample.name;
    EXPECT_EQ(whole.hi, sample.region.hi) << sample.name;
    EXPECT_NEAR(area, sample.region.size().x * sample.region.size().y, 1e-10) << sample.name;
  }
}

TEST(BezierPatches, AreCutAtEveryKnot) {
  Random random(4);
  const BsplineSurface s =
      testing::random_surface(random, {.extra_u = 5, .extra_v = 4, .repeat_knots = true});
  for (const BezierPatch& patch : bezier_patches({s}, {{0, 0}, {1, 1}})) {
    for (double k : s.knots_u) EXPECT_FALSE(k > patch.domain.lo.x && k < patch.domain.hi.x);
    for (double k : s.knots_v) EXPECT_FALSE(k > patch.domain.lo.y && k < patch.domain.hi.y);
    EXPECT_FALSE(patch.rational);
    for (const Vec4& pole : patch.poles) EXPECT_EQ(pole.w, 1);
  }
}

TEST(BezierPatches, DoNotExistForWhatIsNotRational) {
  for (const Sample& sample : testing::offset_samples())
    EXPECT_TRUE(bezier_patches(sample.surface, sample.region).empty()) << sample.name;
  for (const Sample& sample : testing::swept_samples(false))
    if (sample.name.find("hyperbola") != std::string::npos ||
        sample.name.find("offset") != std::string::npos) {
      EXPECT_TRUE(bezier_patches(sample.surface, sample.region).empty()) << sample.name;
    }
  EXPECT_TRUE(bezier_patches({Plane{}}, {}).empty());
}

TEST(BezierPatches, IgnoreSliversBesideAKnot) {
  BsplineSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = 3, s.count_v = 2;
  s.knots_u = {0, 0, 1, 2, 2};
  s.knots_v = {0, 0, 1, 1};
  s.poles = {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_EQ(bezier_patches({s}, {{0, 0}, {1 + 1e-15, 1}}).size(), 1u);
  EXPECT_EQ(bezier_patches({s}, {{0, 0}, {1 + 1e-6, 1}}).size(), 2u);
  // What lies beyond the domain is not there.
  EXPECT_EQ(bezier_patches({s}, {{-1, 0}, {3, 1}}).front().domain.lo.x, 0);
}

TEST(Subpatch, IsThePartOfThePatch) {
  Random random(5);
  for (const Sample& sample : all_samples())
    for (const BezierPatch& patch : bezier_patches(sample.surface, sample.region)) {
      double s0 = random.between(0, 1), s1 = random.between(0, 1), t0 = random.between(0, 1),
             t1 = random.between(0, 1);
      if (s0 > s1) std::swap(s0, s1);
      if (t0 > t1) std::swap(t0, t1);
      const BezierPatch part = subpatch(patch, s0, s1, t0, t1);
      EXPECT_EQ(part.domain.lo.x, patch_to_surface_u(patch, s0));
      EXPECT_EQ(part.domain.hi.y, patch_to_surface_v(patch, t1));
      if (s1 - s0 < 0.01 || t1 - t0 < 0.01) continue;
      for (int i = 0; i < 3; ++i) expect_on_surface(sample, part, random.between(0, 1), random.between(0, 1));
      for (const auto& [s, t] : {std::pair(0.0, 1.0), {1.0, 0.0}, {0.5, 0.5}})
        expect_on_surface(sample, part, s, t);
    }
}

TEST(Subpatch, OfAHalfIsExactInTheMiddle) {
  const Surface cylinder{Cylinder{{}, 2}};
  const BezierPatch patch = bezier_patches(cylinder, {{0, 0}, {1.5, 1}}).front();
  const BezierPatch half = subpatch(patch, 0, 0.5, 0, 1);
  EXPECT_NEAR(half.domain.hi.x, 0.75, 1e-15);
  EXPECT_NEAR(half.pole(2, 0).w, 1, 1e-15);
  EXPECT_NEAR(half.pole(1, 0).w, std::cos(0.375), 1e-15);
}

TEST(BezierCurves, ReproduceTheCurve) {
  Random random(6);
  const Frame3 f = random.frame();
  const std::vector<std::pair<Curve3, Box2>> curves = {
      {{LineOf<Vec3>{f.origin, f.x * 2}}, {{-1, 0}, {3, 0}}},
      {{CircleOf<Vec3>{f.origin, f.x, f.y, 2}}, {{-1, 0}, {5, 0}}},
      {{EllipseOf<Vec3>{f.origin, f.x, f.y, 2, 1}}, {{0.5, 0}, {1, 0}}},
      {{ParabolaOf<Vec3>{f.origin, f.x, f.y, 0.7}}, {{-1, 0}, {2, 0}}},
      {{testing::random_curve(random, 3, 5, true, false)}, {{0.1, 0}, {0.9, 0}}},
      {{testing::random_curve(random, 5, 3, false, true)}, {{0.7, 0}, {1.6, 0}}}};
  for (const auto& [curve, range] : curves) {
    const std::vector<BezierCurve3> pieces = bezier_curves(curve, range.lo.x, range.hi.x);
    ASSERT_FALSE(pieces.empty());
    EXPECT_EQ(pieces.front().t0, range.lo.x);
    EXPECT_EQ(pieces.back().t1, range.hi.x);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(pieces[i].t0, pieces[i - 1].t1);
      }
      // As a patch that is straight in v.
      BezierPatch patch;
      patch.degree_u = pieces[i].degree;
      patch.degree_v = 0;
      patch.domain = {{pieces[i].t0, 0}, {pieces[i].t1, 1}};
      patch.u_is_angle = pieces[i].is_angle;
      patch.poles = pieces[i].poles;
      for (const double s : {0.0, 0.21, 0.5, 0.93, 1.0})
        EXPECT_LE(distance(point_at(patch, s, 0), point_at(curve, patch_to_surface_u(patch, s))),
                  10 * kBezierError);
    }
  }
  const auto base = std::make_shared<const Curve3>(curves[1].first);
  EXPECT_TRUE(bezier_curves({OffsetCurveOf<Vec3>{base, 1, f.z}}, 0, 1).empty());
  EXPECT_TRUE(bezier_curves({HyperbolaOf<Vec3>{f.origin, f.x, f.y, 1, 1}}, 0, 1).empty());
}

}  // namespace
}  // namespace dupin
