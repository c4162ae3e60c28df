// Delaunay stars against the definition: a triangle belongs to the triangulation if the circle around it
// holds no other point.
#include "../../simplify/amg/star.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace dupin::amg {
namespace {

__extension__ using Wide = __int128;

Wide in_circle(const StarPoint& a, const StarPoint& b, const StarPoint& p) {
  const auto square = [](const StarPoint& q) { return Wide(q.x) * q.x + Wide(q.y) * q.y; };
  const auto turn = [](const StarPoint& q, const StarPoint& r) { return Wide(q.x) * r.y - Wide(q.y) * r.x; };
  // > 0: p is inside the circle through the origin, a, b (counter-clockwise).
  return turn(a, p) * square(b) - turn(b, p) * square(a) - turn(a, b) * square(p);
}

void expect_delaunay(const std::vector<StarPoint>& points, const Star& star) {
  ASSERT_FALSE(star.points.empty());
  const std::size_t n = star.points.size();
  int gaps = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const StarPoint &a = star.points[k], &b = star.points[(k + 1) % n];
    if (!less_than_half_turn(a, b)) {
      ++gaps;
      continue;
    }
    for (const StarPoint& p : points)
      if (p.index != a.index && p.index != b.index && (p.x != 0 || p.y != 0)) {
        EXPECT_LE(in_circle(a, b, p), 0) << "a point inside a triangle's circle";
      }
  }
  EXPECT_EQ(star.closed, gaps == 0);
  EXPECT_LE(gaps, 1);
}

std::vector<StarPoint> random_points(std::mt19937& random, int count, int range) {
  std::uniform_int_distribution<std::int64_t> coordinate(-range, range);
  std::vector<StarPoint> points;
  for (int i = 0; i < count; ++i)
    points.push_back({coordinate(random), coordinate(random), static_cast<std::uint32_t>(i)});
  return points;
}

TEST(DelaunayStar, HasEmptyCirclesOnly) {
  std::mt19937 random(7);
  Star star;
  for (int trial = 0; trial < 2000; ++trial) {
    // Small ranges: many points on one circle, in one direction, at one place and at the centre.
    const int range = trial % 4 == 0 ? 3 : trial % 4 == 1 ? 20 : static_cast<int>(kStarRange);
    std::vector<StarPoint> points = random_points(random, 1 + trial % 60, range);
    const std::vector<StarPoint> before = points;
    delaunay_star(points, star);
    if (points.empty()) continue;
    expect_delaunay(before, star);
  }
}

TEST(DelaunayStar, IsClosedInAGridAndOpenAtItsRim) {
  const auto grid = [](int from) {
    std::vector<StarPoint> points;
    for (int x = from; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        points.push_back({x * 1000, y * 1000, static_cast<std::uint32_t>(points.size())});
    return points;
  };
  Star star;
  std::vector<StarPoint> inner = grid(-3), rim = grid(0);
  delaunay_star(inner, star);
  EXPECT_TRUE(star.closed);
  EXPECT_GE(star.points.size(), 4U);
  EXPECT_LE(star.points.size(), 8U);
  EXPECT_NEAR(squared_reach(star), 2e6, 1);
  delaunay_star(rim, star);
  EXPECT_FALSE(star.closed);
  EXPECT_TRUE(std::isinf(squared_reach(star)));
}

TEST(DelaunayStar, DoesNotDependOnTheOrder) {
  std::mt19937 random(3);
  Star a, b;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<StarPoint> points = random_points(random, 40, 1 << 14), shuffled = points;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    delaunay_star(points, a);
    delaunay_star(shuffled, b);
    std::set<std::uint32_t> of_a, of_b;
    for (const StarPoint& p : a.points) of_a.insert(p.index);
    for (const StarPoint& p : b.points) of_b.insert(p.index);
    EXPECT_EQ(of_a, of_b);
  }
}

}  // namespace
}  // namespace dupin::amg
