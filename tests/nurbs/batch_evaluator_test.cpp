// Batches: against one point at a time, 100-digit arithmetic and closed forms; the same bits whatever runs
// them.
#include "../../nurbs/batch_evaluator.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <numbers>

#include "../../core/parallel.h"
#include "kinds.h"
#include "oracle.h"
#include "random_geometry.h"

namespace dupin {
namespace {

using Kind = Curvature::Kind;
using testing::Random;
using testing::Sample;

constexpr double kPi = std::numbers::pi;
constexpr Compute kEverything = Compute::points | Compute::first_derivatives | Compute::second_derivatives |
                                Compute::third_derivatives | Compute::normals | Compute::curvatures |
                                Compute::directions | Compute::mean_and_gauss;

BatchEvaluator evaluator(const Surface& surface) {
  Result<BatchEvaluator> made = BatchEvaluator::make(surface, 3);
  EXPECT_TRUE(made.ok()) << made.status().message;
  return std::move(*made);
}

std::vector<double> between(double lo, double hi, int count) {
  std::vector<double> t;
  for (int i = 0; i < count; ++i) t.push_back(lo + (hi - lo) * (i + 0.37) / count);
  return t;
}

std::vector<Sample> splines() {
  std::vector<Sample> out;
  Random random(5);
  for (const int degree_u : {1, 2, 3, 4, 5, 7})
    for (const int degree_v : {1, 2, 3, 5, 6})
      for (const bool rational : {false, true}) {
        testing::SplineOptions options{.degree_u = degree_u, .degree_v = degree_v, .rational = rational};
        options.repeat_knots = degree_u == degree_v;
        options.periodic_u = degree_u == 3 && degree_v == 5;
        out.push_back({"spline of degrees " + std::to_string(degree_u) + ", " + std::to_string(degree_v) +
                           (rational ? ", rational" : ""),
                       {testing::random_surface(random, options)},
                       {{0, 0}, {1, 1}}});
      }
  return out;
}

std::vector<Sample> every_kind() {
  std::vector<Sample> out = testing::analytic_samples();
  for (auto list : {testing::swept_samples(false), testing::offset_samples(), splines()})
    for (Sample& s : list) out.push_back(std::move(s));
  return out;
}

double jet_scale(const Surface& surface) {
  const auto* s = std::get_if<BsplineSurface>(&surface.geometry);
  if (!s) return surface.geometry.index() < 5 ? 1 : 30;  // profiles may be splines
  const double span = std::min(testing::shortest_span(s->knots_u), testing::shortest_span(s->knots_v));
  return 6 * std::max(s->degree_u, s->degree_v) / span;
}

void expect_jet(const SurfaceSamples& got, std::size_t i, const SurfaceJet& want, double rate) {
  const double e = 4 * 4 * kEvaluateError;
  EXPECT_LE(distance(got.p[i], want.p), e);
  EXPECT_LE(distance(got.pu[i], want.pu), e * rate);
  EXPECT_LE(distance(got.pv[i], want.pv), e * rate);
  const double e2 = e * rate * rate, e3 = e2 * rate;
  EXPECT_LE(distance(got.puu[i], want.puu), e2);
  EXPECT_LE(distance(got.puv[i], want.puv), e2);
  EXPECT_LE(distance(got.pvv[i], want.pvv), e2);
  EXPECT_LE(distance(got.puuu[i], want.puuu), e3);
  EXPECT_LE(distance(got.puuv[i], want.puuv), e3);
  EXPECT_LE(distance(got.puvv[i], want.puvv), e3);
  EXPECT_LE(distance(got.pvvv[i], want.pvvv), e3);
}

void expect_frame(const SurfaceSamples& got, std::size_t i) {
  EXPECT_NEAR(length(got.n[i]), 1, 1e-14);
  EXPECT_NEAR(length(got.d1[i]), 1, 1e-14);
  EXPECT_LE(distance(cross(got.d1[i], got.d2[i]), got.n[i]), 4e-14);
  EXPECT_GE(std::abs(got.k1[i]), std::abs(got.k2[i]) * (1 - 1e-13));
  EXPECT_NEAR(got.mean[i], 0.5 * (got.k1[i] + got.k2[i]), 1e-13 * std::abs(got.k1[i]));
  EXPECT_NEAR(got.gauss[i], got.k1[i] * got.k2[i], 1e-13 * got.k1[i] * got.k1[i]);
}

void expect_curvature(const SurfaceSamples& got, std::size_t i, const Surface& surface, double u, double v) {
  const SurfaceJet jet = evaluate(surface, u, v, 2);
  const Curvature want = principal_curvature(jet);
  const double a = length(jet.pu), d = length(cross(jet.pu, jet.pv)) / a;
  const double scale =
      length(jet.puu) / (a * a) + length(jet.puv) / (a * d) + length(jet.pvv) / (d * d) + std::abs(want.k1);
  const double tolerance = 300 * kCurvatureError * scale * (1 + length(jet.pv) / d);
  EXPECT_NEAR(got.k1[i], want.k1, tolerance);
  EXPECT_NEAR(got.k2[i], want.k2, tolerance);
  EXPECT_LE(distance(got.n[i], want.n), 1e-11);
  if (std::abs(want.k1 - want.k2) > 1e4 * tolerance) {
    EXPECT_LE(length(cross(got.d1[i], want.d1)), 1e-3);
    EXPECT_EQ(got.kind[i], Kind::regular);
  }
  expect_frame(got, i);
}

TEST(BatchEvaluator, AgreesWithOnePointAtATime) {
  for (const Sample& sample : every_kind()) {
    SCOPED_TRACE(sample.name);
    const BatchEvaluator batch = evaluator(sample.surface);
    const auto u = between(sample.region.lo.x, sample.region.hi.x, 7),
               v = between(sample.region.lo.y, sample.region.hi.y, 21);
    SurfaceSamples samples;
    batch.grid(u, v, {kEverything, {}, false}, samples);
    ASSERT_EQ(samples.count, u.size() * v.size());
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j) {
        const std::size_t at = i * v.size() + j;
        expect_jet(samples, at, evaluate(sample.surface, u[i], v[j], 3), jet_scale(sample.surface));
        expect_curvature(samples, at, sample.surface, u[i], v[j]);
        if (::testing::Test::HasFailure()) return;
      }
  }
}

TEST(BatchEvaluator, AgreesWithHundredDigits) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int degree = 2 + static_cast<int>(seed % 4);
    const BsplineSurface s = testing::random_surface(
        random, {.degree_u = degree, .degree_v = 3, .extra_u = 1, .extra_v = 2, .rational = seed % 2 == 0});
    const double u = testing::off_knots(random, s.knots_u, 0, 1),
                 v = testing::off_knots(random, s.knots_v, 0, 1);
    SurfaceSamples got;
    evaluator({s}).scattered({&u, 1}, {&v, 1}, {kEverything, {}, false}, got);
    const oracle::PrincipalCurvatures want = oracle::curvatures({s}, u, v);
    const double tolerance = 10 * kCurvatureError * want.scale;
    EXPECT_NEAR(got.k1[0], want.k1, tolerance);
    EXPECT_NEAR(got.k2[0], want.k2, tolerance);
    EXPECT_LE(distance(got.n[0], want.n), 1e-14);
    EXPECT_LE(length(cross(got.d1[0], want.d1)), tolerance / std::abs(want.k1 - want.k2) + 1e-15);
    const SurfaceJet jet = oracle::surface_jet({s}, u, v);
    EXPECT_LE(distance(got.puuv[0], jet.puuv),
              1e-13 * (length(jet.puuv) + std::pow(jet_scale({s}), 3) / 100));
  }
}

std::vector<double> all_values(const SurfaceSamples& s) {
  std::vector<double> out;
  for (const Vec3Array* a :
       {&s.p, &s.pu, &s.pv, &s.puu, &s.puv, &s.pvv, &s.puuu, &s.puuv, &s.puvv, &s.pvvv, &s.n, &s.d1, &s.d2})
    for (const auto& part : {a->x, a->y, a->z}) out.insert(out.end(), part.begin(), part.end());
  for (const auto& part : {s.k1, s.k2, s.mean, s.gauss}) out.insert(out.end(), part.begin(), part.end());
  for (Kind kind : s.kind) out.push_back(static_cast<double>(kind));
  return out;
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

std::vector<Sample> a_few_kinds() {
  std::vector<Sample> out;
  int index = 0;
  for (Sample& sample : every_kind())
    if (sample.name.find("spline of") == std::string::npos || index++ % 3 == 0)
      out.push_back(std::move(sample));
  return out;
}

TEST(BatchEvaluator, GivesTheSameBitsOnEveryInstructionSet) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  for (const Sample& sample : a_few_kinds()) {
    SCOPED_TRACE(sample.name);
    const BatchEvaluator batch = evaluator(sample.surface);
    const auto u = between(sample.region.lo.x, sample.region.hi.x, 3),
               v = between(sample.region.lo.y, sample.region.hi.y, 13);
    SurfaceSamples samples;
    batch.grid(u, v, {kEverything, {}, true}, samples);
    const std::vector<double> scalar = all_values(samples);
    for (const std::int64_t target : targets) {
      SCOPED_TRACE(hwy::TargetName(target));
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      batch.grid(u, v, {kEverything, {}, false}, samples);
      expect_same_bits(all_values(samples), scalar);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

TEST(BatchEvaluator, GivesAPointTheSameBitsInAnyBatch) {
  for (const Sample& sample : a_few_kinds()) {
    SCOPED_TRACE(sample.name);
    const BatchEvaluator batch = evaluator(sample.surface);
    const auto u = between(sample.region.lo.x, sample.region.hi.x, 40),
               v = between(sample.region.lo.y, sample.region.hi.y, 37);
    SurfaceSamples grid, scattered;
    batch.grid(u, v, {kEverything, {}, false}, grid);
    std::vector<double> at_u, at_v;
    for (double a : u)
      for (double b : v) at_u.push_back(a), at_v.push_back(b);
    for (const int threads : {1, 2}) {
      set_thread_limit(threads);
      batch.scattered(at_u, at_v, {kEverything, {}, false}, scattered);
      set_thread_limit(0);
      expect_same_bits(all_values(scattered), all_values(grid));
    }
    // What is asked for does not change what is computed, nor how many points.
    SurfaceSamples few;
    batch.grid(std::span(u).subspan(5, 1), std::span(v).subspan(3, 2), {Compute::curvatures, {}, false}, few);
    EXPECT_EQ(few.k1[0], grid.k1[5 * v.size() + 3]);
    EXPECT_EQ(few.k2[1], grid.k2[5 * v.size() + 4]);
    EXPECT_TRUE(few.p.x.empty());
  }
}

TEST(BatchEvaluator, TakesTheSideOfAKnotThatIsAskedFor) {
  BsplineSurface s;  // of degree 2 in u with a double knot at ½: a kink
  s.degree_u = 2, s.degree_v = 1;
  s.knots_u = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
  s.knots_v = {0, 0, 1, 1};
  s.count_u = 5, s.count_v = 2;
  for (const Vec3& p : {Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 1}, {3, 0, 0}, {4, 0, -3}})
    s.poles.push_back(p), s.poles.push_back(p + Vec3{0, 1, 0});
  const BatchEvaluator batch = evaluator({s});
  const double u = 0.5, v = 0.5;
  SurfaceSamples left, right;
  batch.grid({&u, 1}, {&v, 1}, {kEverything, {.u_from_left = true}, false}, left);
  batch.grid({&u, 1}, {&v, 1}, {kEverything, {}, false}, right);
  const SurfaceJet before = oracle::surface_jet({s}, u, v, oracle::Side::backward);
  const SurfaceJet after = oracle::surface_jet({s}, u, v, oracle::Side::forward);
  EXPECT_LE(distance(left.pu[0], before.pu), 1e-13);
  EXPECT_LE(distance(left.puu[0], before.puu), 1e-12);
  EXPECT_LE(distance(right.pu[0], after.pu), 1e-13);
  EXPECT_LE(distance(right.puu[0], after.puu), 1e-12);
  EXPECT_GT(distance(left.pu[0], right.pu[0]), 1);
  EXPECT_LE(distance(evaluate({s}, u, v, 1, {.u_from_left = true}).pu, before.pu), 1e-13);
  // A profile's knots likewise.
  Bspline3 profile;
  profile.degree = 2;
  profile.knots = s.knots_u;
  profile.poles = {{1, 0, 0}, {1, 0, 1}, {2, 0, 2}, {1, 0, 3}, {4, 0, 4}};
  SurfaceSamples turned;
  evaluator({Revolution{{}, {0, 0, 1}, {profile}}})
      .grid({&u, 1}, {&v, 1}, {kEverything, {.v_from_left = true}, false}, turned);
  EXPECT_LE(
      distance(turned.pv[0],
               oracle::surface_jet({Revolution{{}, {0, 0, 1}, {profile}}}, u, v, oracle::Side::backward).pv),
      1e-13);
}

TEST(BatchEvaluator, SeesAPeriodicSeamFromBothSides) {
  Random random(8);
  const BsplineSurface s = testing::random_surface(random, {.degree_u = 2, .periodic_u = true});
  const BatchEvaluator batch = evaluator({s});
  const double lo = s.knots_u[2], hi = s.knots_u[static_cast<std::size_t>(s.count_u)], v = 0.4;
  SurfaceSamples start, end;
  batch.grid({&lo, 1}, {&v, 1}, {kEverything, {.u_from_left = true}, false}, start);
  batch.grid({&hi, 1}, {&v, 1}, {kEverything, {.u_from_left = true}, false}, end);
  EXPECT_EQ(start.puu[0], end.puu[0]);
  const double beyond = hi + 0.25 * (hi - lo), inside = lo + 0.25 * (hi - lo);
  batch.grid({&beyond, 1}, {&v, 1}, {kEverything, {}, false}, start);
  batch.grid({&inside, 1}, {&v, 1}, {kEverything, {}, false}, end);
  EXPECT_LE(distance(start.p[0], end.p[0]), 1e-14);
}

void expect_closed_form(const Surface& surface, double u, double v, double k1, double k2) {
  SurfaceSamples got;
  evaluator(surface).grid({&u, 1}, {&v, 1}, {kEverything, {}, false}, got);
  EXPECT_NEAR(got.k1[0], k1, 4e-15 * std::abs(k1)) << u << ", " << v;
  EXPECT_NEAR(got.k2[0], k2, 4e-15 * std::abs(k1)) << u << ", " << v;
}

TEST(BatchEvaluator, KnowsClosedForms) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Frame3 frame = random.frame(), left = random.frame(true);
    const double u = random.between(0, 2 * kPi), v = random.between(-1.5, 1.5);
    expect_closed_form({Sphere{frame, 2.5}}, u, v, -0.4, -0.4);
    expect_closed_form({Sphere{left, 2.5}}, u, v, 0.4, 0.4);
    expect_closed_form({Cylinder{frame, 4}}, u, v, -0.25, 0);
    expect_closed_form({Cone{frame, 3, 0.5}}, u, v, -std::cos(0.5) / (3 + v * std::sin(0.5)), 0);
    const double around = -std::cos(v) / (3 + std::cos(v));
    expect_closed_form({Torus{frame, 3, 1}}, u, v, -1, around);
    expect_closed_form({Torus{left, 3, 1}}, u, v, 1, -around);
    // A hyperboloid of one sheet: r² = a²(1 + z²/b²), like a catenoid at its waist.
    const double a = 2, b = 1.5, c = std::cosh(v), s = std::sinh(v), speed = std::hypot(a * s, b * c);
    const HyperbolaOf<Vec3> meridian{{}, {1, 0, 0}, {0, 0, 1}, a, b};
    const double k_around = -b * c / (speed * a * c), k_along = a * b / std::pow(speed, 3);
    const bool first = std::abs(k_around) >= std::abs(k_along);
    expect_closed_form({Revolution{{}, {0, 0, 1}, {meridian}}}, u, v, first ? k_around : k_along,
                       first ? k_along : k_around);
  }
}

/// The unit sphere's octant pole as a rational biquadratic patch, stretched into an ellipsoid.
BsplineSurface ellipsoid(const Vec3& axes) {
  const double h = std::sqrt(0.5);
  BsplineSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = s.count_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  const Vec2 circle[] = {{1, 0}, {1, 1}, {0, 1}};
  const double weight[] = {1, h, 1};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      s.poles.push_back(
          {axes.x * circle[j].x * circle[i].x, axes.y * circle[j].x * circle[i].y, axes.z * circle[j].y});
      s.weights.push_back(weight[i] * weight[j]);
    }
  return s;
}

TEST(BatchEvaluator, KnowsAnEllipsoidUpToItsPole) {
  const Vec3 axes{3, 2, 1};
  const BatchEvaluator batch = evaluator({ellipsoid(axes)});
  std::vector<double> u = between(0, 1, 9), v = between(0, 1, 40);
  for (const double near : {1e-3, 1e-6, 1e-9}) v.push_back(1 - near);
  SurfaceSamples s;
  batch.grid(u, v, {kEverything, {}, false}, s);
  for (std::size_t i = 0; i < s.count; ++i) {
    // K and H of x²/a² + y²/b² + z²/c² = 1.
    const Vec3 p = s.p[i], q{p.x / 9, p.y / 4, p.z};
    const double f = dot(q, q), abc = 6, gauss = 1 / (f * f * abc * abc);
    const double mean = (dot(p, p) - dot(axes, axes)) / (2 * abc * abc * std::pow(f, 1.5));
    const double outward = dot(s.n[i], p) > 0 ? 1 : -1;
    EXPECT_NEAR(s.gauss[i], gauss, 1e-10 * gauss);
    EXPECT_NEAR(s.mean[i] * outward, mean, 1e-10 * std::abs(mean));
    EXPECT_NE(s.kind[i], Kind::undefined);
  }
}

TEST(BatchEvaluator, SaysWhereALimitWasTaken) {
  const BatchEvaluator batch = evaluator({ellipsoid({1, 1, 1})});
  const double u = 0.3, pole = 1;
  SurfaceSamples s;
  batch.grid({&u, 1}, {&pole, 1}, {kEverything, {}, false}, s);
  EXPECT_EQ(s.kind[0], Kind::singular_limit);
  EXPECT_NEAR(std::abs(s.k1[0]), 1, 1e-8);
  EXPECT_LE(length(cross(s.n[0], {0, 0, 1})), 1e-8);
  // The analytic sphere knows its pole.
  const double north = kPi / 2;
  evaluator({Sphere{{}, 2}}).grid({&u, 1}, {&north, 1}, {kEverything, {}, false}, s);
  EXPECT_EQ(s.kind[0], Kind::singular_limit);
  EXPECT_EQ(s.k1[0], -0.5);
  // A cone's apex has none.
  const double apex = -2 / std::sin(0.5);
  evaluator({Cone{{}, 2, 0.5}}).grid({&u, 1}, {&apex, 1}, {kEverything, {}, false}, s);
  EXPECT_EQ(s.kind[0], Kind::undefined);
  EXPECT_TRUE(std::isnan(s.k1[0]));
  EXPECT_TRUE(std::isfinite(s.p[0].x));
}

TEST(BatchEvaluator, AtAnUmbilicTakesTheBestAxis) {
  Random random(19);
  for (int i = 0; i < 20; ++i) {
    const Frame3 f = random.frame();
    for (const Surface& surface :
         {Surface{Sphere{f, 2.5}}, Surface{Plane{f}}, Surface{ellipsoid({2, 2, 2})}}) {
      const double u = random.between(0.1, 0.9), v = random.between(0.1, 0.9);
      SurfaceSamples s;
      evaluator(surface).grid({&u, 1}, {&v, 1}, {kEverything, {}, false}, s);
      EXPECT_EQ(s.kind[0], Kind::umbilic);
      double best = 0, along = 0;
      for (int a = 0; a < 3; ++a) best = std::max(best, std::sqrt(1 - s.n[0][a] * s.n[0][a]));
      for (int a = 0; a < 3; ++a) along = std::max(along, s.d1[0][a]);
      EXPECT_NEAR(along, best, 1e-12);
      expect_frame(s, 0);
    }
  }
}

TEST(BatchEvaluator, MakesCellsAsTheyAreNeededWhereTheyAreTooManyToKeep) {
  Random random(2);
  constexpr int kCount = 250;
  BsplineSurface s;
  s.degree_u = s.degree_v = 3;
  s.count_u = s.count_v = kCount;
  for (int i = 0; i < kCount + 4; ++i) s.knots_u.push_back((i - 3) / (kCount - 3.0));
  s.knots_v = s.knots_u;
  for (int i = 0; i < kCount * kCount; ++i)
    s.poles.push_back(Vec3{1.0 * (i / kCount), 1.0 * (i % kCount), random.between(0, 1)} * 0.01);
  const BatchEvaluator batch = evaluator({s});
  const auto t = between(0, 1, 9);
  SurfaceSamples samples;
  batch.grid(t, t, {Compute::points | Compute::normals, {}, false}, samples);
  for (std::size_t i = 0; i < samples.count; ++i) {
    const SurfaceJet jet = evaluate({s}, t[i / t.size()], t[i % t.size()], 1);
    EXPECT_LE(distance(samples.p[i], jet.p), 1e-13);
    EXPECT_LE(distance(samples.n[i], normalized(cross(jet.pu, jet.pv))), 1e-11);
  }
}

TEST(BatchEvaluator, TakesEmptyBatches) {
  const BatchEvaluator batch = evaluator({Sphere{{}, 1}});
  SurfaceSamples samples;
  batch.grid({}, {}, {kEverything, {}, false}, samples);
  EXPECT_EQ(samples.count, 0u);
  const double u = 1;
  batch.grid({&u, 1}, {}, {kEverything, {}, false}, samples);
  EXPECT_EQ(samples.count, 0u);
  Random random(1);
  evaluator({testing::random_surface(random, {})}).scattered({}, {}, {kEverything, {}, false}, samples);
  EXPECT_EQ(samples.count, 0u);
}

TEST(BatchEvaluator, RefusesBadSurfacesNamingTheValueAndItsIndex) {
  Random random(1);
  const BsplineSurface good = testing::random_surface(random, {.rational = true});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* expected;
    void (*spoil)(BsplineSurface&);
  };
  const Case cases[] = {
      {"pole 7 is (inf", [](BsplineSurface& s) { s.poles[7].x = std::numeric_limits<double>::infinity(); }},
      {"pole 2 is (", [](BsplineSurface& s) { s.poles[2].y = 1e300; }},
      {"weight 3 is 0", [](BsplineSurface& s) { s.weights[3] = 0; }},
      {"weight 5 is -1", [](BsplineSurface& s) { s.weights[5] = -1; }},
      {"weight 4 is nan", [](BsplineSurface& s) { s.weights[4] = std::numeric_limits<double>::quiet_NaN(); }},
      {"in u a spline's knots decrease: knot 4 is -1", [](BsplineSurface& s) { s.knots_u[4] = -1; }},
      {"in v a spline's knots are not finite: knot 1 is",
       [](BsplineSurface& s) { s.knots_v[1] = std::nan(""); }},
      {"wrong number of knots (8, not 11)", [](BsplineSurface& s) { s.knots_u.resize(8), s.count_u = 7; }},
      {"degree 0 is out of range", [](BsplineSurface& s) { s.degree_v = 0; }},
      {"degree 26 is out of range", [](BsplineSurface& s) { s.degree_u = 26; }},
      {"too few poles (3 for degree 3)", [](BsplineSurface& s) { s.count_u = 3, s.knots_u.resize(7); }},
      {"too few poles (-5 by 7)", [](BsplineSurface& s) { s.count_u = -5; }},
      {"wrong number of knots (11, not 2147483651)", [](BsplineSurface& s) { s.count_u = 2147483647; }},
      {"wrong number of poles (48, not 7 by 7)", [](BsplineSurface& s) { s.poles.pop_back(); }},
      {"domain is empty", [](BsplineSurface& s) { std::fill(s.knots_v.begin(), s.knots_v.end(), 2); }},
  };
  EXPECT_TRUE(BatchEvaluator::make({good}).ok());
  for (const Case& c : cases) {
    BsplineSurface bad = good;
    c.spoil(bad);
    const auto made = BatchEvaluator::make({bad});
    ASSERT_FALSE(made.ok()) << c.expected;
    EXPECT_EQ(made.status().code, StatusCode::invalid_argument);
    EXPECT_NE(made.status().message.find(c.expected), std::string::npos) << made.status().message;
  }
  EXPECT_EQ(BatchEvaluator::make({Sphere{{}, nan}}).status().message,
            "a surface's radius is not positive: nan");
}

}  // namespace
}  // namespace dupin
