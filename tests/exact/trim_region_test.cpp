// Inside or outside of pcurves: beside closed forms, and beside polygons of many corners.
#include "../../exact/trim_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../nurbs/random_geometry.h"
#include "one_face.h"

namespace dupin::exact {
namespace {

using testing::add_loop;
using testing::Random;
constexpr double kPi = std::numbers::pi;

Curve2 segment(Vec2 a, Vec2 b) {
  return {LineOf<Vec2>{a, b - a}};
}

Model plane_with(const std::vector<Curve2>& pcurves, const std::vector<ParameterRange>& ranges,
                 double half = 10) {
  Model model = testing::empty_model();
  testing::add_face(model, {Plane{}}, {{-half, -half}, {half, half}});
  add_loop(model, 0, pcurves, ranges);
  return model;
}
bool contains(const Model& model, Vec2 uv) {
  return TrimRegion(model.parts[0], model.parts[0].faces[0]).contains(uv);
}

TEST(TrimRegion, ACircleIsExactToRounding) {
  const Vec2 x{0.6, 0.8}, y{-0.8, 0.6};
  const Model model = plane_with({{CircleOf<Vec2>{{0.3, -0.2}, x, y, 1.25}}}, {{0.4, 0.4 + 2 * kPi}});
  const TrimRegion region(model.parts[0], model.parts[0].faces[0]);
  for (int i = 0; i < 1000; ++i) {
    const double a = 0.013 + 2 * kPi * i / 1000;
    for (const double r : {1.25 - 1e-13, 1.25 + 1e-13}) {
      Vec2 p{0.3 + r * std::cos(a), -0.2 + r * std::sin(a)};
      EXPECT_EQ(region.contains(p), r < 1.25) << a;
    }
  }
  EXPECT_LT(region.widest_gap(), 1e-15);
}

TEST(TrimRegion, AnEllipseAndItsHole) {
  Model model = plane_with({{EllipseOf<Vec2>{{0, 0}, {0, 1}, {-1, 0}, 3, 1}}}, {{0, 2 * kPi}});
  add_loop(model, 0, {{CircleOf<Vec2>{{0, 1}, {1, 0}, {0, 1}, 0.5}}}, {{-kPi, kPi}});
  const auto inside = [](Vec2 p) {
    return p.y * p.y / 9 + p.x * p.x < 1 && (p.y - 1) * (p.y - 1) + p.x * p.x > 0.25;
  };
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 p{random.between(-1.2, 1.2), random.between(-3.2, 3.2)};
    EXPECT_EQ(contains(model, p), inside(p)) << p.x << " " << p.y;
  }
}

bool in_polygon(const std::vector<Vec2>& polygon, Vec2 p) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) odd = !odd;
  }
  return odd;
}
double distance_to(const std::vector<Vec2>& polygon, Vec2 p) {
  double least = INFINITY;
  for (const Vec2& q : polygon) least = std::min(least, length(q - p));
  return least;
}

TEST(TrimRegion, SplineLoopsAgreeWithFinePolygons) {
  for (int seed = 0; seed < 8; ++seed) {
    Random random(20 + seed);
    const Bspline2 spline = random_plane_curve(random, random.integer(1, 5), 6, seed % 2 == 1);
    const Curve2 curve{spline};
    const ParameterRange range = domain(curve);
    const Vec2 first = point_at(curve, range.lo), last = point_at(curve, range.hi);
    const Model model = plane_with({curve, segment(last, first)}, {range, {0, 1}});
    const TrimRegion region(model.parts[0], model.parts[0].faces[0]);
    std::vector<Vec2> polygon;
    Box2 box;
    for (int i = 0; i <= 4000; ++i)
      polygon.push_back(point_at(curve, range.lo + (range.hi - range.lo) * i / 4000));
    for (const Vec2& p : polygon) box.add(p);
    int tested = 0;
    for (int i = 0; i < 500; ++i) {
      Vec2 p{random.between(box.lo.x, box.hi.x), random.between(box.lo.y, box.hi.y)};
      if (distance_to(polygon, p) < 0.01 * length(box.size())) continue;
      ++tested;
      EXPECT_EQ(region.contains(p), in_polygon(polygon, p)) << seed << ": " << p.x << " " << p.y;
    }
    EXPECT_GT(tested, 200);
  }
}

TEST(TrimRegion, ParabolasHyperbolasAndOffsets) {
  // v = u²/4f under v = 1; the hyperbola's branch; a circle's offset, which OCCT turns to the right.
  const double f = 0.25;
  const Model bowl = plane_with({{ParabolaOf<Vec2>{{0, 0}, {0, 1}, {1, 0}, f}}, segment({1, 1}, {-1, 1})},
                                {{-1, 1}, {0, 1}});
  EXPECT_TRUE(contains(bowl, {0.5, 0.2500001}));
  EXPECT_FALSE(contains(bowl, {0.5, 0.2499999}));
  const double t = std::acosh(2.0);
  const Model branch = plane_with({{HyperbolaOf<Vec2>{{0, 0}, {0, 1}, {1, 0}, 1, 0.5}},
                                   segment({0.5 * std::sinh(t), 2}, {-0.5 * std::sinh(t), 2})},
                                  {{-t, t}, {0, 1}});
  const auto edge = [](double u) { return std::sqrt(1 + 4 * u * u); };
  EXPECT_TRUE(contains(branch, {0.3, edge(0.3) + 1e-9}));
  EXPECT_FALSE(contains(branch, {0.3, edge(0.3) - 1e-9}));
  const auto base = std::make_shared<const Curve2>(Curve2{CircleOf<Vec2>{{0, 0}, {1, 0}, {0, 1}, 1}});
  const Model wider = plane_with({{OffsetCurveOf<Vec2>{base, 0.5, {}}}}, {{0, 2 * kPi}});
  for (int i = 0; i < 100; ++i) {
    const double a = 0.1 + 0.0627 * i;
    EXPECT_TRUE(contains(wider, {(1.5 - 1e-9) * std::cos(a), (1.5 - 1e-9) * std::sin(a)})) << a;
    EXPECT_FALSE(contains(wider, {(1.5 + 1e-9) * std::cos(a), (1.5 + 1e-9) * std::sin(a)})) << a;
  }
}

TEST(TrimRegion, RaysThroughCornersCountOnce) {
  const std::vector<Vec2> corners{{0, 0}, {1, 0.5}, {2, 0}, {2, 1}, {1, 0.5}, {0, 1}};  // touches itself
  std::vector<Curve2> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) sides.push_back(segment(corners[i], corners[(i + 1) % 6]));
  const Model model = plane_with(sides, std::vector<ParameterRange>(6, {0, 1}));
  EXPECT_TRUE(contains(model, {0.25, 0.5}));
  EXPECT_TRUE(contains(model, {1.75, 0.5}));
  EXPECT_FALSE(contains(model, {-0.25, 0.5}));
  EXPECT_FALSE(contains(model, {2.25, 0.5}));
  EXPECT_FALSE(contains(model, {1, 0.75}));
}

TEST(TrimRegion, APointIsFoundWholeTurnsAway) {
  // A band about a cylinder across the seam: u from 5 to 8, as loops have it; points come with u in (−π, π].
  Model model = testing::empty_model();
  testing::add_face(model, {Cylinder{{}, 1}}, {{5, 0}, {8, 1}});
  add_loop(
      model, 0,
      {segment({5, 0}, {8, 0}), segment({8, 0}, {8, 1}), segment({8, 1}, {5, 1}), segment({5, 1}, {5, 0})},
      std::vector<ParameterRange>(4, {0, 1}));
  const TrimRegion region(model.parts[0], model.parts[0].faces[0]);
  for (const double u : {5.01, 6.0, 7.0, 7.99}) {
    Vec2 p{u - 2 * kPi, 0.5};
    ASSERT_TRUE(region.contains(p)) << u;
    EXPECT_NEAR(p.x, u, 1e-14);
  }
  for (const double u : {4.99, 8.01, 2.0}) {
    Vec2 p{u, 0.5};
    EXPECT_FALSE(region.contains(p)) << u;
  }
}

TEST(TrimRegion, GapsBetweenPcurvesAreBridged) {
  const double gap = 1e-5;
  const Model model = plane_with({segment({0, 0}, {1, 0}), segment({1, gap}, {1, 1}), segment({1, 1}, {0, 1}),
                                  segment({0, 1 - gap}, {0, 0})},
                                 std::vector<ParameterRange>(4, {0, 1}));
  const TrimRegion region(model.parts[0], model.parts[0].faces[0]);
  EXPECT_NEAR(region.widest_gap(), gap, 1e-15);
  for (const double v : {gap / 2, 1 - gap / 2}) {
    Vec2 in{0.5, v}, out{1.5, v}, left{-0.5, v};
    EXPECT_TRUE(region.contains(in));
    EXPECT_FALSE(region.contains(out));
    EXPECT_FALSE(region.contains(left));
  }
}

}  // namespace
}  // namespace dupin::exact
