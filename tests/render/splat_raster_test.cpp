#include "../../render/splat_raster.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "../../core/parallel.h"

namespace dupin {
namespace {

constexpr int kSize = 64;

/// Parallel: grid steps are pixels, row 0 at y = 0; nearer with larger z.
SplatProjection flat(double scale = 1) {
  SplatProjection p;
  p.x = {2.0 * scale / kSize, 0, 0, -1}, p.y = {0, 2.0 * scale / kSize, 0, -1}, p.depth = {0, 0, -1, 1000};
  p.perspective = false;
  p.depth_terms = {1, -1e-3, 0};
  p.pixels_per_step = scale;
  return p;
}

EncodedNode node(double x, double y, double z, double radius) {
  PointNode n;
  n.center = {x, y, z}, n.radius = radius, n.normal = {0, 0, 1};
  return encode(n);
}

std::uint32_t number_at(const SplatRaster& raster, int x, int y) {
  const std::uint64_t pixel = raster.pixels()[static_cast<std::size_t>(y * raster.width() + x)];
  return pixel == 0 ? 0xffffffffU : ~static_cast<std::uint32_t>(pixel);
}
std::size_t covered(const SplatRaster& raster) {
  std::size_t count = 0;
  for (const std::uint64_t pixel : raster.pixels()) count += pixel != 0;
  return count;
}

/// In pieces of 4096, on several threads.
void add_points(SplatRaster& raster, const SplatProjection& projection, std::span<const EncodedNode> nodes,
                std::uint32_t first, Splatting splatting) {
  std::vector<std::uint32_t> all(nodes.size());
  std::iota(all.begin(), all.end(), 0U);
  constexpr std::size_t kPiece = 4096;
  parallel_for((all.size() + kPiece - 1) / kPiece, [&](std::size_t i) {
    const std::size_t from = i * kPiece, count = std::min(kPiece, all.size() - from);
    const SplatList list{std::span(all).subspan(from, count), first + static_cast<std::uint32_t>(from)};
    raster.add_points(
        projection, {&list, 1},
        [&](std::span<const std::uint32_t> items, EncodedNode* to) {
          for (const std::uint32_t k : items) *to++ = nodes[k];
        },
        splatting);
  });
}
/// Each triangle as a leaf of its own.
void add_triangles(SplatRaster& raster, const SplatProjection& projection,
                   std::span<const SplatVertex> vertices, std::span<const SplatTriangle> triangles,
                   std::span<const std::uint32_t> leaves, std::uint32_t first) {
  const SplatList list{leaves, first};
  raster.add_triangles(projection, vertices, triangles, {&list, 1}, [](std::uint32_t leaf) {
    return std::array{leaf, leaf + 1};
  });
}

SplatVertex vertex(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return {{x | y << 21, y >> 11 | z << 10}, 0, 0};
}

TEST(SplatRaster, APointCoversThePixelsWithinItsRadiusAndAtLeastOne) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  const EncodedNode nodes[] = {node(10, 10, 5, 0), node(30, 30, 5, 4)};
  add_points(raster, flat(), nodes, 7, Splatting::simple);
  EXPECT_EQ(number_at(raster, 10, 10), 7u);
  std::size_t disc = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool within = std::hypot(x + 0.5 - 30, y + 0.5 - 30) <= 4;
      EXPECT_EQ(number_at(raster, x, y) == 8u, within) << x << ' ' << y;
      disc += within;
    }
  EXPECT_EQ(covered(raster), disc + 1);
  EXPECT_LE(raster.rows()[0], 10);
  EXPECT_GE(raster.rows()[1], 34);
}

TEST(SplatRaster, TheNearestIsKeptAndOfEqualOnesTheFirst) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  const EncodedNode nodes[] = {node(9, 9, 1, 3), node(9, 9, 8, 2), node(9, 9, 8, 2)};
  add_points(raster, flat(), nodes, 0, Splatting::simple);
  EXPECT_EQ(number_at(raster, 9, 9), 1u);
  EXPECT_EQ(number_at(raster, 11, 9), 0u);
}

TEST(SplatRaster, DiscsOfOneSlantedPlaneMeetHalfway) {
  PointNode a;
  a.radius = 8;
  a.normal = normalized(Vec3{1, 0, 1});
  PointNode b = a;
  a.center = {20, 20, 40}, b.center = {26, 20, 34};
  SplatProjection tilted = flat(), facing = flat();
  facing.flat = true;
  const EncodedNode nodes[] = {encode(a), encode(b)};
  SplatRaster raster;
  raster.begin(kSize, kSize);
  add_points(raster, tilted, nodes, 0, Splatting::simple);
  for (int x = 13; x < 33; ++x) EXPECT_EQ(number_at(raster, x, 20), x < 23 ? 0u : 1u) << x;
  raster.begin(kSize, kSize);
  add_points(raster, facing, nodes, 0, Splatting::simple);
  EXPECT_EQ(number_at(raster, 27, 20), 0u) << "the nearer one reaches over the other's middle";
}

/// A disc of radius 12 seen from 60° aside: half as wide in the direction in which it goes back, more by what
/// its normals allow it to bend, and a circle where nothing is known of them.
TEST(SplatRaster, DiscsAreAsNarrowAsTheyAreSeenAndTheirNormalsAllow) {
  PointNode n;
  n.center = {32, 32, 50}, n.radius = 12;
  n.normal = {std::sqrt(0.75), 0, 0.5};
  SplatProjection p = flat();
  p.perspective = false, p.eye = {0, 0, 1}, p.foreshortened = true;
  const auto half_axes = [&](std::uint32_t cone) {
    n.cone = cone;
    const EncodedNode nodes[] = {encode(n)};
    SplatRaster raster;
    raster.begin(kSize, kSize);
    add_points(raster, p, nodes, 0, Splatting::simple);
    int wide = 0, high = 0;
    for (int i = 0; i < kSize; ++i) {
      wide += number_at(raster, i, 32) == 0;
      high += number_at(raster, 32, i) == 0;
    }
    return std::array{wide, high};
  };
  const double bent = 0.5 + std::sqrt(0.75) * 0.25;
  EXPECT_NEAR(half_axes(0)[0], 12, 1);
  EXPECT_NEAR(half_axes(0)[1], 24, 1);
  EXPECT_NEAR(half_axes(64)[0], 24 * bent, 1);
  EXPECT_NEAR(half_axes(64)[1], 24, 1);
  EXPECT_NEAR(half_axes(kNoCone)[0], 24, 1);
  EXPECT_NEAR(half_axes(kNoCone)[1], 24, 1);
  p.foreshortened = false;
  EXPECT_NEAR(half_axes(0)[0], 24, 1);
}

TEST(SplatRaster, HolesLieBehindTheMiddlesOfTheirNeighbours) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  const EncodedNode nodes[] = {node(10, 10, 50, 4), node(12, 10, 49, 4)};
  add_points(raster, flat(), nodes, 0, Splatting::visibility);
  EXPECT_EQ(number_at(raster, 10, 10), 0u);
  EXPECT_EQ(number_at(raster, 12, 10), 1u);
  EXPECT_EQ(number_at(raster, 11, 10), SplatRaster::kHole | 0u);
  EXPECT_EQ(number_at(raster, 15, 10), SplatRaster::kHole | 1u);
}

TEST(SplatRaster, WhatLiesOutsideOrBehindIsLeftOut) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  SplatProjection p = flat();
  p.x[3] = -1e9;
  const EncodedNode far[] = {node(10, 10, 5, 4)};
  add_points(raster, p, far, 0, Splatting::simple);
  p = flat();
  p.perspective = true, p.depth = {0, 0, 1, -10}, p.depth_terms = {0, 0, 1}, p.nearest_depth = 0.1;
  const EncodedNode behind[] = {node(10, 10, 5, 4)};
  add_points(raster, p, behind, 0, Splatting::simple);
  EXPECT_EQ(covered(raster), 0u);
}

/// Random triangulations of the picture: every pixel is covered by exactly one triangle, whatever the order
/// and the turn of its corners.
TEST(SplatRaster, NeighbouringTrianglesShareNoPixelAndLeaveNone) {
  for (int seed = 0; seed < 20; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const double scale = 1 / 16.0;  // 16 steps a pixel
    const int n = 2 + seed;
    std::vector<SplatVertex> vertices;
    const std::uint32_t extent = 16 * kSize;
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        const auto jitter = [&](int i) {
          const bool border = i == 0 || i == n;
          const std::uint32_t at = extent * static_cast<std::uint32_t>(i) / static_cast<std::uint32_t>(n);
          return border ? at : at + random() % (extent / static_cast<std::uint32_t>(3 * n));
        };
        vertices.push_back(vertex(jitter(x), jitter(y), 5));
      }
    std::vector<SplatTriangle> triangles;
    const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), 0});
        triangles.push_back({at(x + 1, y + 1), at(x, y), at(x, y + 1), 0});
        if (random() % 2) std::swap(triangles.back()[0], triangles.back()[1]);
      }
    std::vector<int> count(kSize * kSize, 0);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      SplatRaster raster;
      raster.begin(kSize, kSize);
      const std::uint32_t list[] = {t};
      add_triangles(raster, flat(scale), vertices, triangles, list, 3);
      for (int i = 0; i < kSize * kSize; ++i) {
        if (raster.pixels()[static_cast<std::size_t>(i)] == 0) continue;
        ++count[static_cast<std::size_t>(i)];
        EXPECT_EQ(number_at(raster, i % kSize, i / kSize), SplatRaster::kTriangle | 3u);
      }
    }
    for (const int c : count) ASSERT_EQ(c, 1) << "seed " << seed;
  }
}

TEST(SplatRaster, DepthIsTheTrianglesOwn) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  const SplatVertex vertices[] = {vertex(0, 0, 100), vertex(kSize * 2, 0, 300), vertex(0, kSize * 2, 500)};
  const SplatTriangle triangles[] = {{0, 1, 2, 0}};
  const std::uint32_t list[] = {0};
  add_triangles(raster, flat(), vertices, triangles, list, 0);
  EXPECT_EQ(covered(raster), static_cast<std::size_t>(kSize * kSize));
  for (int y = 0; y < kSize; y += 7)
    for (int x = 0; x < kSize; x += 5) {
      const double z = 100 + 200 * (x + 0.5) / (2 * kSize) + 400 * (y + 0.5) / (2 * kSize);
      const auto pixel = raster.pixels()[static_cast<std::size_t>(y * kSize + x)];
      EXPECT_NEAR(std::bit_cast<float>(static_cast<std::uint32_t>(pixel >> 32)), 1 - 1e-3 * (1000 - z), 1e-5);
    }
}

/// In perspective, a floor that goes on behind the eye: cut at the nearest depth, and as it would be in
/// pieces.
TEST(SplatRaster, TrianglesAreCutAtTheNearestDepthAndTheGuardBand) {
  SplatProjection p;
  const double c = 1 << 20;  // the eye's place
  p.x = {1, 0, 0, -c}, p.y = {0, -1, 0, c}, p.depth = {0, 0, 1, -c};
  p.depth_terms = {0, 0, 0.5}, p.nearest_depth = 0.5;
  const auto at = [c](double x, double y, double z) {
    return vertex(static_cast<std::uint32_t>(c + x), static_cast<std::uint32_t>(c + y),
                  static_cast<std::uint32_t>(c + z));
  };
  const SplatVertex vertices[] = {at(-900000, -1, -900000), at(900000, -1, -900000), at(0, -1, 900000)};
  const SplatTriangle triangles[] = {{0, 1, 2, 0}};
  const std::uint32_t list[] = {0};
  SplatRaster raster;
  raster.begin(kSize, kSize);
  add_triangles(raster, p, vertices, triangles, list, 0);
  for (int y = 0; y < kSize; ++y)
    EXPECT_EQ(number_at(raster, kSize / 2, y) != 0xffffffffU, y >= kSize / 2) << y;
  const auto near = raster.pixels()[static_cast<std::size_t>((kSize - 1) * kSize + kSize / 2)];
  EXPECT_NEAR(std::bit_cast<float>(static_cast<std::uint32_t>(near >> 32)),
              0.5 * (kSize - 0.5 - kSize / 2) / (kSize / 2), 1e-4);
}

TEST(SplatRaster, LeavesHaveFourNumbersEach) {
  SplatRaster raster;
  raster.begin(kSize, kSize);
  std::vector<SplatVertex> vertices;
  std::vector<SplatTriangle> triangles;
  for (std::uint32_t i = 0; i < 5; ++i) {  // one above the other
    for (const auto& [x, y] : {std::array{0U, 0U}, std::array{8U, 0U}, std::array{0U, 8U}})
      vertices.push_back(vertex(x, y + 10 * i, 5));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
  }
  const std::array<std::uint32_t, 2> ranges[] = {{3, 5}, {0, 3}};
  const std::uint32_t leaves[] = {1, 0};
  const SplatList list{leaves, 8};
  raster.add_triangles(flat(), vertices, triangles, {&list, 1}, [&](std::uint32_t i) { return ranges[i]; });
  const std::uint32_t expected[] = {8, 9, 10, 12, 13};
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(number_at(raster, 1, 10 * i + 1), SplatRaster::kTriangle | expected[i]) << i;
}

TEST(SplatRaster, TheNextPictureBeginsEmptyAndThreadsDoNotMatter) {
  std::mt19937 random(5);
  std::vector<EncodedNode> nodes;
  for (int i = 0; i < 20000; ++i)
    nodes.push_back(node(random() % kSize, random() % kSize, random() % 200, (random() % 40) / 10.0));
  SplatRaster several, one;
  several.begin(kSize, kSize);
  add_points(several, flat(), nodes, 0, Splatting::visibility);
  set_thread_limit(1);
  one.begin(kSize, kSize);
  add_points(one, flat(), nodes, 0, Splatting::visibility);
  set_thread_limit(0);
  EXPECT_EQ(one.pixels(), several.pixels());
  several.begin(kSize, kSize);
  EXPECT_EQ(covered(several), 0u);
  several.begin(10, 20);
  EXPECT_EQ(several.pixels().size(), 200u);
}

}  // namespace
}  // namespace dupin
