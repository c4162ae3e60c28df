#include "../../sampling/chart_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

QuadricDp plane_dp(double half) {
  QuadricDp dp;
  dp.planar = true;
  dp.footprint = {Vec2{-half, -half}, Vec2{half, -half}, Vec2{half, half}, Vec2{-half, half}};
  dp.z_lo = -1, dp.z_hi = 1;
  return dp;
}

/// A closed chain of lines and arcs of circles around the origin, radius changing from corner to corner.
ChartPieces star(int corners, std::mt19937& rng, std::vector<Vec2>& outline) {
  std::uniform_real_distribution<double> radius(0.4, 0.9), bend(-0.4, 0.4), weight(0.4, 2);
  std::vector<Vec2> c;
  for (int i = 0; i < corners; ++i) {
    const double a = 2 * kPi * i / corners, r = radius(rng);
    c.push_back({r * std::cos(a), r * std::sin(a)});
  }
  ChartPieces pieces;
  for (int i = 0; i < corners; ++i) {
    const Vec2 a = c[i], b = c[(i + 1) % corners];
    outline.push_back(a);
    if (i % 3 == 0) {
      pieces.lines.push_back({a, b, true});
      continue;
    }
    const Vec2 d = b - a, p1 = (a + b) * 0.5 + Vec2{-d.y, d.x} * bend(rng);
    const double w = weight(rng);
    pieces.arcs.push_back({a, p1, b, w, true});
    for (int k = 1; k < 400; ++k) {
      const double s = k / 400.0, e0 = (1 - s) * (1 - s), e1 = 2 * w * s * (1 - s), e2 = s * s;
      outline.push_back((a * e0 + p1 * e1 + b * e2) / (e0 + e1 + e2));
    }
  }
  return pieces;
}

bool even_odd(const std::vector<Vec2>& polygon, Vec2 p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    if ((polygon[i].y > p.y) != (polygon[j].y > p.y) &&
        p.x < polygon[j].x +
                  (polygon[i].x - polygon[j].x) * (p.y - polygon[j].y) / (polygon[i].y - polygon[j].y))
      inside = !inside;
  return inside;
}

TEST(ChartRegion, ParityAgreesWithAFinePolygon) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> at(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec2> outline;
    const ChartPieces pieces = star(5 + trial % 4, rng, outline);
    PartDps part;
    emit_dp(plane_dp(1), pieces, {-1.1, -1.05}, false, part);
    int disagreements = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec2 p{at(rng), at(rng)};
      disagreements += region_contains(part, part.dps[0], {p.x, p.y, 0}) != even_odd(outline, p);
    }
    EXPECT_LE(disagreements, 2);  // points within a chord's sagitta of the outline
  }
}

TEST(ChartRegion, AnyReferenceGivesTheSameRegion) {
  std::mt19937 rng(8);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Vec2> outline;
  const ChartPieces pieces = star(7, rng, outline);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec2 r{at(rng), at(rng)};
    PartDps a, b;
    emit_dp(plane_dp(1), pieces, {-1.1, -1.05}, false, a);
    emit_dp(plane_dp(1), pieces, r, state_at(pieces, {-1.1, -1.05}, false, r), b);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p{at(rng), at(rng), 0};
      EXPECT_EQ(region_contains(a, a.dps[0], p), region_contains(b, b.dps[0], p));
    }
  }
}

TEST(ChartRegion, SplittingTheFootprintChangesNothing) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Vec2> outline;
  ChartPieces pieces = star(60, rng, outline);
  for (int i = 0; i < 12; ++i)
    pieces.ellipses.push_back(
        {{0.2 * std::cos(i * kPi / 6), 0.2 * std::sin(i * kPi / 6)}, 1 / 0.03, 0, 1 / 0.02, true});
  PartDps whole, parts;
  emit_dp(plane_dp(1), pieces, {-1.1, -1.05}, false, whole);
  const int count = emit_exact_dp(plane_dp(1), pieces, {-1.1, -1.05}, false, parts);
  EXPECT_GT(count, 4);
  for (const QuadricDp& dp : parts.dps) EXPECT_LE(dp.lines + dp.arcs + dp.ellipses, kMaxPieces);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{at(rng), at(rng), 0};
    int holders = 0;
    for (const QuadricDp& dp : parts.dps) holders += region_contains(parts, dp, p);
    EXPECT_EQ(holders > 0, region_contains(whole, whole.dps[0], p));
    EXPECT_LE(holders, 1);
  }
}

TEST(ChartRegion, PointsOnSharedEndPointsAreCountedOnce) {
  // A fan of chords through the same corners, and rays from the reference exactly through them.
  ChartPieces pieces;
  const Vec2 c[4] = {{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}};
  for (int i = 0; i < 4; ++i) pieces.lines.push_back({c[i], c[(i + 1) % 4], false});
  PartDps part;
  emit_dp(plane_dp(2), pieces, {0, 0}, true, part);
  for (double f : {0.25, 0.5, 0.75, 0.999})
    EXPECT_TRUE(region_contains(part, part.dps[0], {0.5 * f, 0.5 * f, 0}));
  for (double f : {1.001, 1.5, 3.0}) EXPECT_FALSE(region_contains(part, part.dps[0], {0.5 * f, 0.5 * f, 0}));
}

}  // namespace
}  // namespace dupin
