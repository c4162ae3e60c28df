// Covers of planar regions against the region's own test.
#include "../../render/planar_cover.h"

#include <gtest/gtest.h>

#include <random>

#include "hand_made.h"

namespace dupin::testing {
namespace {

struct Disagreements {
  int uncovered = 0, overfull = 0, wrong = 0, doubled = 0;
};

Disagreements disagreements(const PartDps& part, const QuadricDp& dp, const PlanarCover& cover,
                            unsigned seed) {
  Box2 box;
  for (const Vec2 c : dp.footprint) box.add(c);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Disagreements d;
  for (int k = 0; k < 20000; ++k) {
    const Vec2 p = box.lo + Vec2{box.size().x * unit(random), box.size().y * unit(random)};
    const bool inside = region_contains(part, dp, {p.x, p.y, 0});
    int rectangles = 0;
    for (const Box2& b : cover.inside)
      if (b.contains(p)) {
        ++rectangles;
        d.overfull += !inside;
      }
    for (const BoundaryRectangle& r : cover.boundary)
      if (r.box.contains(p)) {
        ++rectangles;
        d.wrong += boundary_contains(r, p) != pieces_contain(part, dp, p);
      }
    d.uncovered += inside && rectangles == 0;
    d.doubled += rectangles > 1;
  }
  return d;
}

void expect_exact(const PartDps& part, const QuadricDp& dp, unsigned seed) {
  for (const int resolution : {6, 12, 24}) {
    const Disagreements d = disagreements(part, dp, planar_cover(part, dp, resolution), seed);
    EXPECT_EQ(d.uncovered, 0) << resolution;
    EXPECT_EQ(d.overfull, 0) << resolution;
    EXPECT_EQ(d.wrong, 0) << resolution;
    EXPECT_EQ(d.doubled, 0) << resolution;
  }
}

TEST(PlanarCover, PlateWithRoundedCornersAndAnEllipticHole) {
  const HandMade made = every_kind();
  expect_exact(made.dps.parts[0], made.dps.parts[0].dps[0], 1);
}

/// A star of random corners around the middle, some of its sides bulged into arcs.
TEST(PlanarCover, RandomStars) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (unsigned trial = 0; trial < 40; ++trial) {
    PartDps part;
    QuadricDp dp = plane_rectangle({}, {1, 0, 0}, {0, 1, 0}, 2.2, 2.2);
    const int n = 4 + static_cast<int>(8 * unit(random));
    std::vector<Vec2> corners;
    for (int k = 0; k < n; ++k) {
      const double angle = (k + 0.6 * unit(random)) * 2 * 3.14159265358979323846 / n,
                   radius = 0.25 + 0.8 * unit(random);
      corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    for (int k = 0; k < n; ++k) {
      const Vec2 a = corners[static_cast<std::size_t>(k)], b = corners[static_cast<std::size_t>((k + 1) % n)];
      if (unit(random) < 0.5) {
        part.lines.push_back({a, b, k % 2 == 0});
      } else {
        const Vec2 across{a.y - b.y, b.x - a.x};
        part.arcs.push_back(
            {a, (a + b) * 0.5 + across * (0.4 * (unit(random) - 0.5)), b, 0.5 + unit(random), k % 2 == 0});
      }
    }
    dp.lines = static_cast<std::uint16_t>(part.lines.size());
    dp.arcs = static_cast<std::uint16_t>(part.arcs.size());
    dp.reference = {1.05, 1.07};
    dp.reference_inside = false;
    expect_exact(part, dp, trial);
  }
}

TEST(PlanarCover, WhatIsLeftToTestIsSmall) {
  const HandMade made = every_kind();
  const PlanarCover cover = planar_cover(made.dps.parts[0], made.dps.parts[0].dps[0], 24);
  double inside = 0, boundary = 0;
  const auto area = [](const Box2& b) { return b.size().x * b.size().y; };
  for (const Box2& b : cover.inside) inside += area(b);
  for (const BoundaryRectangle& r : cover.boundary) boundary += area(r.box);
  EXPECT_GT(inside, 1.8);
  EXPECT_LT(boundary, 2.0);
}

}  // namespace
}  // namespace dupin::testing
