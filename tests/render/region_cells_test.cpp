// Convex cells against the region that they are made of.
#include "../../render/region_cells.h"

#include <gtest/gtest.h>

#include "random_regions.h"

namespace dupin::testing {
namespace {

struct Disagreements {
  int points = 0, uncovered = 0, overfull = 0, doubled = 0;
};

Disagreements disagreements(const PartDps& part, const QuadricDp& dp, const std::vector<RegionCell>& cells,
                            unsigned seed) {
  Box2 box;
  for (const Vec2 c : dp.footprint) box.add(c);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Disagreements d;
  for (int k = 0; k < 4000; ++k) {
    const Vec2 p = box.lo + Vec2{box.size().x * unit(random), box.size().y * unit(random)};
    QuadricDp flat = dp;
    flat.planes = 0, flat.z_lo = -1, flat.z_hi = 1;
    const bool inside = region_contains(part, flat, {p.x, p.y, 0});
    const auto holding =
        std::count_if(cells.begin(), cells.end(), [&](const RegionCell& c) { return cell_contains(c, p); });
    ++d.points;
    d.uncovered += inside && holding == 0;
    d.overfull += !inside && holding > 0;
    d.doubled += holding > 1;
  }
  return d;
}

bool convex(const RegionCell& cell) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = cell.corners[k], b = cell.corners[(k + 1) % 4], c = cell.corners[(k + 2) % 4];
    if (cross(b - a, c - b) < -1e-12) return false;
  }
  return true;
}

void expect_exact(const PartDps& part, const QuadricDp& dp, const std::vector<RegionCell>& cells,
                  unsigned seed) {
  const Disagreements d = disagreements(part, dp, cells, seed);
  EXPECT_EQ(d.uncovered, 0) << "seed " << seed << ", " << cells.size() << " cells";
  EXPECT_EQ(d.overfull, 0) << "seed " << seed << ", " << cells.size() << " cells";
  EXPECT_EQ(d.doubled, 0) << "seed " << seed << ", " << cells.size() << " cells";
  for (const RegionCell& cell : cells) EXPECT_TRUE(convex(cell)) << "seed " << seed;
}

TEST(RegionCells, OfAPlateWithRoundedCornersAndAnEllipticHoleAreFew) {
  const HandMade made = every_kind();
  const std::vector<RegionCell> cells = region_cells(made.dps.parts[0], made.dps.parts[0].dps[0]);
  EXPECT_GE(cells.size(), 10u);
  EXPECT_LE(cells.size(), 16u);
  expect_exact(made.dps.parts[0], made.dps.parts[0].dps[0], cells, 1);
}

TEST(RegionCells, OfAQuadrilateralAreOne) {
  PartDps part;
  QuadricDp dp = plane_rectangle({}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  const Vec2 corners[] = {{-0.5, -0.7}, {0.6, -0.5}, {0.4, 0.8}, {-0.7, 0.3}};
  for (int k = 0; k < 4; ++k) part.lines.push_back({corners[k], corners[(k + 1) % 4], true});
  dp.lines = 4;
  dp.reference_inside = true;
  const auto cells = region_cells(part, dp);
  // Its corners are at four abscissas; the trapezoids between them have no side in common with both
  // neighbours.
  EXPECT_LE(cells.size(), 3u);
  expect_exact(part, dp, cells, 1);
}

/// Nothing of the footprint's middle lies outside of the ellipse's parallelogram.
TEST(RegionCells, OfADiscInItsSquareAreTheDisc) {
  for (const double square : {2.0, 2.0001, 2.5})
    for (const bool hole : {false, true}) {
      PartDps part;
      QuadricDp dp = plane_rectangle({}, {1, 0, 0}, {0, 1, 0}, square, square);
      part.ellipses.push_back({{0, 0}, 1, 0, 1, true});
      dp.ellipses = 1;
      dp.reference_inside = hole;  // with the ellipse, which holds the reference, folded in
      const auto cells = region_cells(part, dp);
      EXPECT_TRUE(hole || cells.size() == 1u);
      expect_exact(part, dp, cells, 1);
    }
}

TEST(RegionCells, WhatIsAllOutsideHasNone) {
  PartDps part;
  QuadricDp dp = plane_rectangle({}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  dp.reference_inside = false;
  EXPECT_TRUE(region_cells(part, dp).empty());
}

/// Regions whose pieces run into one another may have none.
TEST(RegionCells, OfRandomRegionsAreTheRegion) {
  int told = 0, untold = 0;
  for (const int corners : {5, 12, 40})
    for (unsigned seed = 1; seed <= 60; ++seed) {
      RandomRegions random{std::mt19937(seed)};
      PartDps part;
      const QuadricDp dp = random.dp(part, true, corners);
      const auto cells = region_cells(part, dp);
      if (cells.empty()) {
        ++untold;
        continue;
      }
      ++told;
      expect_exact(part, dp, cells, seed);
    }
  EXPECT_GT(told, 60);
  EXPECT_GT(untold, 0);
}

}  // namespace
}  // namespace dupin::testing
