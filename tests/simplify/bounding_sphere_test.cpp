#include "../../simplify/bounding_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace dupin {
namespace {

constexpr double kRounding = 1e-12;

class Random {
 public:
  explicit Random(int seed) : engine_(static_cast<unsigned>(seed)) {}
  double operator()(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  Vec3 point() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }

 private:
  std::mt19937 engine_;
};

/// The smallest radius by a slow search from many starts.
double smallest_radius(const std::vector<Sphere>& spheres) {
  double best = 1e9;
  for (const Sphere& start : spheres) {
    Vec3 at = start.center;
    for (int i = 1; i < 20000; ++i) {
      const Sphere* farthest = &spheres[0];
      for (const Sphere& s : spheres)
        if (distance(at, s.center) + s.radius > distance(at, farthest->center) + farthest->radius)
          farthest = &s;
      at += (farthest->center - at) * (0.5 / i);
      best = std::min(best, radius_around(at, spheres));
    }
  }
  return best;
}

TEST(TriangleSphere, IsTheSmallestThatContainsTheCorners) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 a = random.point(), b = random.point(), c = trial % 3 ? random.point() : a + (b - a) * 0.3;
    const Sphere s = triangle_sphere(a, b, c);
    for (const Vec3& p : {a, b, c}) EXPECT_LE(distance(s.center, p), s.radius * (1 + kRounding));
    // No sphere is smaller than half the longest edge, nor than the circumcircle of an acute triangle.
    EXPECT_GE(s.radius, 0.5 * std::max({distance(a, b), distance(a, c), distance(b, c)}) * (1 - kRounding));
    const Vec3 corner_sum = (a - s.center) + (b - s.center) + (c - s.center);
    EXPECT_LT(length(corner_sum), 3 * s.radius);
  }
}

TEST(TriangleSphere, FollowsThePapersTwoCases) {
  const Sphere acute = triangle_sphere({0, 0, 0}, {2, 0, 0}, {1, 1.7, 0});
  EXPECT_NEAR(distance(acute.center, {0, 0, 0}), acute.radius, 1e-12);
  EXPECT_NEAR(distance(acute.center, {1, 1.7, 0}), acute.radius, 1e-12);
  const Sphere obtuse = triangle_sphere({0, 0, 0}, {4, 0, 0}, {1, 0.5, 0});
  EXPECT_EQ(obtuse.center, (Vec3{2, 0, 0}));
  EXPECT_EQ(obtuse.radius, 2);
  EXPECT_EQ(triangle_sphere({1, 1, 1}, {1, 1, 1}, {1, 1, 1}).radius, 0);
}

TEST(SphereOfSpheres, ContainsThemAndIsNearlyTheSmallest) {
  Random random(2);
  double worst = 1, published = 0, ours = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Sphere> spheres(2 + static_cast<std::size_t>(trial) % 3);
    for (Sphere& s : spheres) s = {random.point(), random(0, trial % 5 ? 0.6 : 0)};
    const Sphere whole = sphere_of_spheres(spheres);
    for (const Sphere& s : spheres)
      EXPECT_LE(distance(whole.center, s.center) + s.radius, whole.radius * (1 + kRounding));
    const double smallest = smallest_radius(spheres);
    worst = std::max(worst, whole.radius / smallest);
    published += published_sphere_of_spheres(spheres).radius / smallest, ours += whole.radius / smallest;
  }
  EXPECT_LT(worst, 1.02);
  EXPECT_LE(ours, published);
}

TEST(SphereOfSpheres, OneThatContainsTheOthersIsTheAnswer) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 0.1}, {{0.2, 0, 0}, 2}, {{-0.3, 0.1, 0}, 0.5}};
  const Sphere whole = sphere_of_spheres(spheres);
  EXPECT_EQ(whole.center, (Vec3{0.2, 0, 0}));
  EXPECT_EQ(whole.radius, 2);
}

TEST(SphereOfSpheres, TwoFollowThePapersFormula) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1}, {{4, 0, 0}, 0.5}};
  const Sphere whole = published_sphere_of_spheres(spheres);
  EXPECT_NEAR(whole.radius, (4 + 1 + 0.5) / 2, 1e-15);
  EXPECT_NEAR(whole.center.x, 1.75, 1e-15);
}

TEST(SphereOfSpheres, EqualAndFlatOnesWork) {
  const std::vector<Sphere> same(4, Sphere{{1, 2, 3}, 0.5});
  EXPECT_EQ(sphere_of_spheres(same).radius, 0.5);
  const std::vector<Sphere> line{{{0, 0, 0}, 0}, {{1, 0, 0}, 0}, {{2, 0, 0}, 0}, {{3, 0, 0}, 0}};
  EXPECT_NEAR(sphere_of_spheres(line).radius, 1.5, 0.05);
  const std::vector<Sphere> square{{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{1, 1, 0}, 1}, {{0, 1, 0}, 1}};
  EXPECT_NEAR(sphere_of_spheres(square).radius, 1 + std::sqrt(0.5), 1e-9);
}

}  // namespace
}  // namespace dupin
