#include <gtest/gtest.h>

#include "../../nurbs/knots.h"
#include "../../nurbs/surface.h"
#include "oracle.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using oracle::Side;
using testing::Random;

constexpr double kUlp = 0x1p-52;

struct Scale {
  double extent, rate_u, rate_v;
};

double rate(const std::vector<double>& knots, int degree, const std::vector<double>& weights) {
  double lightest = 1, heaviest = 1;
  for (double w : weights) lightest = std::min(lightest, w), heaviest = std::max(heaviest, w);
  return 2 * degree * heaviest / lightest / testing::shortest_span(knots);
}

/// The scale of kEvaluateError.
Scale scale_of(const BsplineSurface& s) {
  Box3 box;
  for (const Vec3& p : s.poles) box.add(p);
  return {box.diagonal(), rate(s.knots_u, s.degree_u, s.weights), rate(s.knots_v, s.degree_v, s.weights)};
}

void expect_within_error(const SurfaceJet& got, const SurfaceJet& want, const Scale& scale) {
  const Vec3 g[] = {got.p, got.pu, got.pv, got.puu, got.puv, got.pvv, got.puuu, got.puuv, got.puvv, got.pvvv};
  const Vec3 w[] = {want.p,   want.pu,   want.pv,   want.puu,  want.puv,
                    want.pvv, want.puuu, want.puuv, want.puvv, want.pvvv};
  for (int n = 0, k = 0; n <= 3; ++n)
    for (int j = 0; j <= n; ++j, ++k) {
      const double size = scale.extent * std::pow(scale.rate_u, n - j) * std::pow(scale.rate_v, j);
      EXPECT_LE(distance(g[k], w[k]), kEvaluateError * size + (k == 0 ? 2 * kUlp * length(w[0]) : 0))
          << "derivative " << n - j << ", " << j;
    }
}

void compare_with_oracle(const BsplineSurface& s, double u, double v, Side side = Side::central) {
  SCOPED_TRACE("u = " + std::to_string(u) + ", v = " + std::to_string(v));
  const Surface surface{s};
  expect_within_error(evaluate(surface, u, v, 3), oracle::surface_jet(surface, u, v, side), scale_of(s));
}

TEST(SplineSurface, AgreesWithTheDefinitionForEveryDegree) {
  for (int degree = 1; degree <= 11; ++degree)
    for (const bool rational : {false, true}) {
      SCOPED_TRACE("degree " + std::to_string(degree) + (rational ? ", rational" : ""));
      Random random(static_cast<std::uint64_t>(degree * 2 + rational));
      const BsplineSurface s = testing::random_surface(random, {.degree_u = degree,
                                                                .degree_v = 1 + (degree + 4) % 11,
                                                                .extra_u = 2,
                                                                .extra_v = 1,
                                                                .rational = rational});
      for (int i = 0; i < 8; ++i)
        compare_with_oracle(s, testing::off_knots(random, s.knots_u, 0, 1),
                            testing::off_knots(random, s.knots_v, 0, 1));
    }
}

TEST(SplineSurface, AgreesAtRepeatedKnotsFromTheRightAndAtTheEnds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const BsplineSurface s = testing::random_surface(random, {.degree_u = 3,
                                                              .degree_v = 2,
                                                              .extra_u = 4,
                                                              .extra_v = 3,
                                                              .rational = seed % 2 == 0,
                                                              .repeat_knots = true});
    for (int i = 0; i < 3; ++i) compare_with_oracle(s, s.knots_u[3 + i], s.knots_v[2 + i % 2], Side::forward);
    compare_with_oracle(s, 1, 1, Side::backward);
  }
}

TEST(SplineSurface, WrapsIntoThePeriodAndClampsOtherwise) {
  Random random(7);
  const BsplineSurface s = testing::random_surface(
      random, {.degree_u = 3, .degree_v = 2, .extra_u = 3, .rational = true, .periodic_u = true});
  const Surface surface{s};
  EXPECT_EQ(period_u(surface), 1);
  EXPECT_EQ(period_v(surface), 0);
  for (int i = 0; i < 3; ++i) {
    const double u = testing::off_knots(random, s.knots_u, 0, 1),
                 v = testing::off_knots(random, s.knots_v, 0, 1);
    compare_with_oracle(s, u, v);
    EXPECT_LE(distance(point_at(surface, u + 2, v), point_at(surface, u, v)), 1e-13);
    EXPECT_LE(distance(point_at(surface, u - 1, v), point_at(surface, u, v)), 1e-13);
  }
  // The seam is as smooth as any other knot.
  const SurfaceJet before = evaluate(surface, -1e-9, 0.4, 2), after = evaluate(surface, 1e-9, 0.4, 2);
  EXPECT_LE(distance(before.p, after.p), 1e-7);
  EXPECT_LE(distance(before.puu, after.puu), 1e-4);
  EXPECT_EQ(point_at(surface, 0.3, 7), point_at(surface, 0.3, 1));
}

TEST(SplineSurface, KeepsItsDerivativesFarFromTheOrigin) {
  for (const bool rational : {false, true}) {
    Random random(11);
    const BsplineSurface s = testing::random_surface(random, {.degree_u = 3,
                                                              .degree_v = 4,
                                                              .extra_u = 2,
                                                              .extra_v = 2,
                                                              .rational = rational,
                                                              .origin = {1e6, -1e6, 3e5}});
    for (int i = 0; i < 3; ++i)
      compare_with_oracle(s, testing::off_knots(random, s.knots_u, 0, 1),
                          testing::off_knots(random, s.knots_v, 0, 1));
  }
}

TEST(SplineSurface, LeavesDerivativesAboveTheOrderZero) {
  Random random(3);
  const Surface surface{testing::random_surface(random, {})};
  const SurfaceJet whole = evaluate(surface, 0.3, 0.6, 3), first = evaluate(surface, 0.3, 0.6, 1);
  EXPECT_EQ(first.p, whole.p);
  EXPECT_EQ(first.pv, whole.pv);
  EXPECT_EQ(first.puv, Vec3{});
  EXPECT_EQ(first.pvvv, Vec3{});
}

template <class V, class Spline>
void compare_curve(const Spline& c, double t, Side side = Side::central) {
  const CurveOf<V> curve{c};
  const auto got = evaluate(curve, t, 3);
  const auto want = oracle::curve_jet(curve, t, side);
  double extent = 0;
  for (const V& p : c.poles) extent = std::max(extent, length(p - c.poles.front()));
  double size = 2 * extent;
  for (int k = 0; k < 4; ++k, size *= rate(c.knots, c.degree, c.weights))
    EXPECT_LE(length(got[k] - want[k]), kEvaluateError * size + (k == 0 ? 2 * kUlp * length(want[0]) : 0))
        << "derivative " << k << " at " << t;
}

TEST(SplineCurve, AgreesWithTheDefinitionForEveryDegree) {
  for (int degree = 1; degree <= 11; ++degree)
    for (const bool rational : {false, true}) {
      SCOPED_TRACE("degree " + std::to_string(degree) + (rational ? ", rational" : ""));
      Random random(static_cast<std::uint64_t>(100 + degree * 2 + rational));
      const Bspline3 space = testing::random_curve(random, degree, 3, rational, false, {1e5, 0, 0});
      const Bspline2 plane = testing::random_plane_curve(random, degree, 3, rational);
      for (int i = 0; i < 3; ++i) {
        compare_curve<Vec3>(space, testing::off_knots(random, space.knots, 0, 1));
        compare_curve<Vec2>(plane, testing::off_knots(random, plane.knots, 0, 1));
      }
      compare_curve<Vec3>(space, space.knots[degree + 1], Side::forward);
      compare_curve<Vec2>(plane, 1, Side::backward);
    }
}

TEST(SplineCurve, IsPeriodic) {
  Random random(5);
  const Bspline3 c = testing::random_curve(random, 4, 3, true, true);
  compare_curve<Vec3>(c, 0.123);
  const Curve3 curve{c};
  EXPECT_EQ(period(curve), 1);
  EXPECT_LE(distance(point_at(curve, 0.123), point_at(curve, -3 + 0.123)), 1e-13);
  EXPECT_LE(distance(point_at(curve, 0), point_at(curve, 1)), 1e-13);
}

TEST(SplineCurve, BreaksWhereItsKnotsSay) {
  Bspline2 c;
  c.degree = 3;
  c.knots = {0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4};
  c.poles.resize(10);
  const Curve2 curve{c};
  EXPECT_EQ(breaks(curve, 0, 4, 1), (std::vector<double>{3}));
  EXPECT_EQ(breaks(curve, 0, 4, 2), (std::vector<double>{2, 3}));
  EXPECT_EQ(breaks(curve, 0, 4, 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(breaks(curve, 1, 3, 3), (std::vector<double>{2}));
  const Curve2 offset{OffsetCurveOf<Vec2>{std::make_shared<const Curve2>(curve), 1, {}}};
  EXPECT_EQ(breaks(offset, 0, 4, 1), (std::vector<double>{2, 3}));
  Random random(1);
  const Curve3 closed{testing::random_curve(random, 3, 2, false, true)};
  const std::vector<double> twice = breaks(closed, -0.5, 1.5, 3);
  EXPECT_TRUE(std::is_sorted(twice.begin(), twice.end()));
  EXPECT_EQ(std::count(twice.begin(), twice.end(), 0.0), 1);
  EXPECT_EQ(std::count(twice.begin(), twice.end(), 1.0), 1);
  EXPECT_EQ(twice.size(), 10u);
}

TEST(Knots, FindTheSpanThatHoldsAParameter) {
  const std::vector<double> knots{0, 0, 0, 1, 2, 2, 3, 3, 3};
  EXPECT_EQ(find_span(knots, 2, 0), 2);
  EXPECT_EQ(find_span(knots, 2, 1), 3);
  EXPECT_EQ(find_span(knots, 2, 1, true), 2);
  EXPECT_EQ(find_span(knots, 2, 2), 5);
  EXPECT_EQ(find_span(knots, 2, 2, true), 3);
  EXPECT_EQ(find_span(knots, 2, 3), 5);
  EXPECT_EQ(find_span(knots, 2, 9), 5);
  EXPECT_EQ(find_span(knots, 2, -1), 2);
}

TEST(Knots, BasisFunctionsAreAPartitionOfUnityOfTheHighestDegree) {
  Random random(9);
  const std::vector<double> knots = testing::random_knots(random, kMaxDegree, 4, false);
  for (double t = 0; t <= 1; t += 0.05) {
    std::array<double, 4 * (kMaxDegree + 1)> n;
    basis_derivatives(knots, kMaxDegree, find_span(knots, kMaxDegree, t), t, 3, n.data());
    for (int k = 0; k <= 3; ++k) {
      double sum = 0, size = 0;
      for (int j = 0; j <= kMaxDegree; ++j) {
        sum += n[k * (kMaxDegree + 1) + j];
        size += std::abs(n[k * (kMaxDegree + 1) + j]);
      }
      EXPECT_NEAR(sum, k == 0 ? 1 : 0, 1e-14 * size);
    }
  }
}

}  // namespace
}  // namespace dupin
