#include "../../render/seen_numbers.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace dupin {
namespace {

constexpr std::uint32_t kHole = SplatRaster::kHole, kTriangle = SplatRaster::kTriangle;

std::uint64_t pixel_of(std::uint32_t depth, std::uint32_t number) {
  return std::uint64_t{depth} << 32 | static_cast<std::uint32_t>(~number);
}

/// Every pixel's old number has one new one, in the same order, without gaps; depths and kinds stay.
TEST(SeenNumbers, AreThoseOfThePictureWithoutGaps) {
  constexpr int kSize = 50;
  constexpr std::uint32_t kEnd = 100000;
  for (int seed = 0; seed < 10; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    SplatRaster raster;
    raster.begin(kSize, kSize);
    PointNode whole;  // over all rows, so that all are looked at
    whole.center = {25, 25, 5}, whole.radius = 40;
    SplatProjection projection;
    projection.x = {2.0 / kSize, 0, 0, -1}, projection.y = {0, 2.0 / kSize, 0, -1};
    projection.depth = {0, 0, -1, 1000}, projection.perspective = false;
    projection.depth_terms = {1, -1e-3, 0};
    const std::uint32_t item[] = {0};
    const SplatList list{item, 0};
    raster.add_points(
        projection, {&list, 1}, [&](std::span<const std::uint32_t>, EncodedNode* to) { *to = encode(whole); },
        Splatting::simple);
    std::set<std::uint32_t> points, triangles;
    for (int y = 0; y < kSize; ++y)
      for (std::uint64_t& pixel : raster.row(y)) {
        const std::uint32_t number = seed % 2 ? random() % kEnd : random() % 40 + kEnd - 40;
        const std::uint32_t kind = random() % 4;
        pixel = kind == 0   ? 0
                : kind == 1 ? pixel_of(random() | 1, kTriangle | number)
                            : pixel_of(random() | 1, number | (kind == 2 ? kHole : 0));
        if (kind == 1) triangles.insert(number);
        if (kind > 1) points.insert(number);
      }
    const std::vector<std::uint64_t> before = raster.pixels();
    SeenNumbers seen;
    seen.collect(raster, kEnd, kEnd);
    EXPECT_EQ(seen.points.size(), points.size());
    EXPECT_EQ(seen.triangles.size(), triangles.size());
    const auto rank = [](const std::set<std::uint32_t>& set, std::uint32_t number) {
      return static_cast<std::uint32_t>(std::distance(set.begin(), set.find(number)));
    };
    for (std::size_t i = 0; i < before.size(); ++i) {
      const std::uint64_t now = raster.pixels()[i];
      ASSERT_EQ(now == 0, before[i] == 0);
      if (now == 0) continue;
      const auto was = ~static_cast<std::uint32_t>(before[i]), is = ~static_cast<std::uint32_t>(now);
      ASSERT_EQ(now >> 32, before[i] >> 32);
      if (was & kTriangle)
        ASSERT_EQ(is, kTriangle | rank(triangles, was & ~kTriangle));
      else
        ASSERT_EQ(is, (was & kHole) | rank(points, was & ~kHole));
    }
  }
}

TEST(SeenNumbers, ASetIsWalkedBetweenAnyTwoNumbers) {
  for (int seed = 0; seed < 50; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const std::uint32_t end = 1 + random() % 300;
    NumberSet set;
    set.clear(end);
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < end; ++i)
      if (random() % 3 == 0) set.add(i), expected.insert(i);
    set.count();
    ASSERT_EQ(set.size(), expected.size());
    const std::size_t first = random() % (end + 1), last = first + random() % (end + 1 - first);
    auto at = expected.lower_bound(static_cast<std::uint32_t>(first));
    set.each(first, last, [&](std::size_t number, std::uint32_t less) {
      ASSERT_TRUE(at != expected.end());
      EXPECT_EQ(number, *at++);
      EXPECT_EQ(less, static_cast<std::uint32_t>(std::distance(
                          expected.begin(), expected.find(static_cast<std::uint32_t>(number)))));
      EXPECT_EQ(set.less_than(number), less);
    });
    EXPECT_EQ(at, expected.lower_bound(static_cast<std::uint32_t>(last)));
    EXPECT_EQ(set.less_than(end), expected.size());
  }
}

}  // namespace
}  // namespace dupin
