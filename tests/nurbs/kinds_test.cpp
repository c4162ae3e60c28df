// Analytic, swept and offset surfaces, and conics: against 100-digit evaluation of their formulas, and closed
// forms.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "kinds.h"
#include "oracle.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using testing::Random;
using testing::Sample;

constexpr double kTurn = 2 * std::numbers::pi;

double largest_error(const SurfaceJet& got, const SurfaceJet& want) {
  const double errors[] = {distance(got.p, want.p),       distance(got.pu, want.pu),
                           distance(got.pv, want.pv),     distance(got.puu, want.puu),
                           distance(got.puv, want.puv),   distance(got.pvv, want.pvv),
                           distance(got.puuu, want.puuu), distance(got.puuv, want.puuv),
                           distance(got.puvv, want.puvv), distance(got.pvvv, want.pvvv)};
  double largest = 0;
  for (double e : errors) largest = e <= largest ? largest : e;  // NaN gets through
  return largest;
}

Vec2 point_in(Random& random, const Box2& box) {
  return {random.between(box.lo.x, box.hi.x), random.between(box.lo.y, box.hi.y)};
}

TEST(AnalyticSurface, AgreesWithItsFormula) {
  Random random(5);
  for (const Sample& sample : testing::analytic_samples())
    for (int i = 0; i < 4; ++i) {
      const Vec2 q = point_in(random, sample.region);
      EXPECT_LE(
          largest_error(evaluate(sample.surface, q.x, q.y, 3), oracle::surface_jet(sample.surface, q.x, q.y)),
          kEvaluateError * sample.extent)
          << sample.name;
    }
}

/// The largest rate of kEvaluateError to the third power: 1 unless a spline is in it.
double third_power_of_rate(const Sample& sample) {
  return sample.name.find("spline") == std::string::npos ? 1 : std::pow(2 * 3 * 2.7 / 0.05, 3);
}

TEST(SweptSurface, AgreesWithItsFormula) {
  Random random(6);
  for (const Sample& sample : testing::swept_samples(false))
    for (int i = 0; i < 3; ++i) {
      const Vec2 q = point_in(random, sample.region);
      EXPECT_LE(
          largest_error(evaluate(sample.surface, q.x, q.y, 3), oracle::surface_jet(sample.surface, q.x, q.y)),
          4 * kEvaluateError * sample.extent * third_power_of_rate(sample))
          << sample.name;
    }
}

TEST(OffsetSurface, AgreesWithItsDefinition) {
  Random random(7);
  for (const Sample& sample : testing::offset_samples()) {
    if (sample.name == "offset of an offset")
      continue;  // differences of differences of differences: closed form below
    for (int i = 0; i < 3; ++i) {
      const Vec2 q = point_in(random, sample.region);
      const SurfaceJet got = evaluate(sample.surface, q.x, q.y, 3),
                       want = oracle::surface_jet(sample.surface, q.x, q.y);
      EXPECT_LE(distance(got.p, want.p), 4 * kEvaluateError * sample.extent) << sample.name;
      const double size = length(want.puu) + length(want.puv) + length(want.pvv),
                   third = 1 + length(want.puuu) + length(want.pvvv);
      EXPECT_LE(distance(got.puu, want.puu) + distance(got.puv, want.puv) + distance(got.pvv, want.pvv),
                1e-11 * size)
          << sample.name;
      EXPECT_LE(distance(got.puuu, want.puuu) + distance(got.puuv, want.puuv) +
                    distance(got.puvv, want.puvv) + distance(got.pvvv, want.pvvv),
                1e-10 * third)
          << sample.name;
    }
  }
}

TEST(OffsetSurface, OfATorusIsATorus) {
  Random random(8);
  for (const bool left_handed : {false, true}) {
    const Frame3 f = random.frame(left_handed);
    const auto torus = std::make_shared<const Surface>(Surface{Torus{f, 3, 0.7}});
    const auto once = std::make_shared<const Surface>(Surface{OffsetSurface{torus, 0.25}});
    const Surface twice{OffsetSurface{once, -0.5}};
    // The normal Su × Sv points outward for a right-handed frame.
    const double sign = left_handed ? -1 : 1;
    for (int i = 0; i < 5; ++i) {
      const double u = random.between(0, kTurn), v = random.between(0, kTurn);
      EXPECT_LE(largest_error(evaluate(*once, u, v, 3), evaluate({Torus{f, 3, 0.7 + sign * 0.25}}, u, v, 3)),
                1e-13);
      EXPECT_LE(largest_error(evaluate(twice, u, v, 3), evaluate({Torus{f, 3, 0.7 - sign * 0.25}}, u, v, 3)),
                1e-12);
    }
    EXPECT_EQ(period_u(twice), kTurn);
    EXPECT_EQ(period_v(twice), kTurn);
  }
}

TEST(OffsetSurface, HasALimitAtAPole) {
  Random random(9);
  const Frame3 f = random.frame();
  const Surface sphere{Sphere{f, 2}};
  const Surface offset{OffsetSurface{std::make_shared<const Surface>(sphere), 0.5}};
  for (const double v : {-kTurn / 4, kTurn / 4})
    EXPECT_LE(distance(point_at(offset, 1.2, v), f.origin + f.z * std::copysign(2.5, v)), 1e-9);
}

TEST(Surface, KnowsItsDomainAndPeriods) {
  Random random(10);
  const Frame3 f = random.frame();
  EXPECT_EQ(domain({Sphere{f, 1}}).hi.y, kTurn / 4);
  EXPECT_TRUE(std::isinf(domain({Plane{f}}).lo.x));
  EXPECT_EQ(period_u({Cone{f, 1, 0.3}}), kTurn);
  EXPECT_EQ(period_v({Cone{f, 1, 0.3}}), 0);
  EXPECT_EQ(period_v({Torus{f, 2, 1}}), kTurn);
  const Curve3 circle{CircleOf<Vec3>{f.origin, f.x, f.y, 1}}, line{LineOf<Vec3>{f.origin, f.z}};
  EXPECT_EQ(period_u({Extrusion{circle, f.z}}), kTurn);
  EXPECT_EQ(period_u({Extrusion{line, f.x}}), 0);
  EXPECT_EQ(period_v({Revolution{f.origin, f.z, circle}}), kTurn);
  EXPECT_EQ(domain({Extrusion{circle, f.z}}).hi.x, kTurn);
  EXPECT_TRUE(std::isinf(domain({Revolution{f.origin, f.z, line}}).hi.y));
  EXPECT_EQ(kind_name({Revolution{f.origin, f.z, circle}}), "revolution");
  EXPECT_EQ(kind_name({OffsetSurface{std::make_shared<const Surface>(), 1}}), "offset");
  EXPECT_TRUE(is_quadric({Sphere{f, 1}}));
  EXPECT_FALSE(is_quadric({Torus{f, 2, 1}}));
}

TEST(Curve, AgreesWithItsFormula) {
  Random random(12);
  const Frame3 f = random.frame();
  const Vec2 x{0.6, 0.8}, y{-0.8, 0.6};
  const auto ellipse2 = std::make_shared<const Curve2>(Curve2{EllipseOf<Vec2>{{1, 2}, x, y, 2, 0.7}});
  const auto ellipse3 = std::make_shared<const Curve3>(Curve3{EllipseOf<Vec3>{f.origin, f.x, f.y, 2, 0.7}});
  const std::vector<Curve2> plane = {{LineOf<Vec2>{{1, 2}, {3, -1}}},
                                     {CircleOf<Vec2>{{1, 2}, x, y, 1.4}},
                                     *ellipse2,
                                     {ParabolaOf<Vec2>{{1, 2}, x, y, 0.6}},
                                     {HyperbolaOf<Vec2>{{1, 2}, x, y, 1, 0.5}},
                                     {OffsetCurveOf<Vec2>{ellipse2, 0.1, {}}}};
  const std::vector<Curve3> space = {{LineOf<Vec3>{f.origin, f.z * 2}},
                                     {CircleOf<Vec3>{f.origin, f.x, f.y, 1.4}},
                                     *ellipse3,
                                     {ParabolaOf<Vec3>{f.origin, f.x, f.y, 0.6}},
                                     {HyperbolaOf<Vec3>{f.origin, f.x, f.y, 1, 0.5}},
                                     {OffsetCurveOf<Vec3>{ellipse3, 0.1, normalized(f.z + f.x * 0.2)}}};
  for (int i = 0; i < 5; ++i) {
    const double t = random.between(-1.5, 1.5);
    for (std::size_t c = 0; c < plane.size(); ++c) {
      const auto got = evaluate(plane[c], t, 3), want = oracle::curve_jet(plane[c], t);
      for (int k = 0; k < 4; ++k)
        EXPECT_LE(length(got[k] - want[k]), 5e-13) << "curve " << c << ", derivative " << k;
    }
    for (std::size_t c = 0; c < space.size(); ++c) {
      const auto got = evaluate(space[c], t, 3), want = oracle::curve_jet(space[c], t);
      for (int k = 0; k < 4; ++k)
        EXPECT_LE(length(got[k] - want[k]), 5e-13) << "curve " << c << ", derivative " << k;
    }
  }
}

TEST(Curve, OffsetsToTheRightOfItsDirection) {
  const auto line = std::make_shared<const Curve2>(Curve2{LineOf<Vec2>{{0, 0}, {2, 0}}});
  EXPECT_EQ(point_at(Curve2{OffsetCurveOf<Vec2>{line, 3, {}}}, 1), (Vec2{2, -3}));
}

}  // namespace
}  // namespace dupin
