#include "../../simplify/point_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "../../simplify/mesh_block.h"
#include "../../simplify/tree_shape.h"

namespace dupin {
namespace {

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

TEST(PointNode, RadiiAreRoundedUpAndNotByMuch) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-9, 20.9);
  for (int i = 0; i < 100000; ++i) {
    const double r = std::exp2(exponent(random)), back = decode_radius(encode_radius(r));
    EXPECT_GE(back, r);
    EXPECT_LE(back, r * (1 + 1.0 / 2047));
    EXPECT_EQ(encode_radius(back), encode_radius(r));
  }
  EXPECT_EQ(decode_radius(encode_radius(0)), 0);
  EXPECT_GT(decode_radius(encode_radius(1e-12)), 0);
}

TEST(PointNode, NormalsComeBackWithinTheirError) {
  std::mt19937 random(2);
  double worst = 0;
  const auto test = [&](const Vec3& n) {
    const Vec3 back = decode_normal(encode_normal(n));
    EXPECT_NEAR(length(back), 1, 1e-12);
    worst = std::max(worst, std::atan2(length(cross(n, back)), dot(n, back)));
    // What a bound was computed for must not move again, though on the octahedron's rim two codes are one
    // direction.
    EXPECT_LT(length(decode_normal(encode_normal(back)) - back), 1e-12);
  };
  for (int i = 0; i < 100000; ++i) test(random_direction(random));
  for (int i = 0; i < 3; ++i)
    for (const double s : {-1.0, 1.0}) {
      Vec3 axis;
      axis[i] = s;
      test(axis);
    }
  EXPECT_LT(worst, kNormalError);
  EXPECT_GT(worst, kNormalError / 2) << "the bound is not needlessly large";
}

TEST(PointNode, ComesBackAsItWent) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::uint32_t> grid(0, kLargestGridCoordinate);
  for (int i = 0; i < 10000; ++i) {
    PointNode node;
    node.center = {double(grid(random)), double(grid(random)), double(grid(random))};
    node.radius = decode_radius(random() % 65536);
    node.normal = decode_normal(encode_normal(random_direction(random)));
    node.cone = random() % 256, node.triangles = 1 + random() % 4, node.color = random() % 65536;
    const PointNode back = decode(encode(node));
    EXPECT_EQ(back.center, node.center);
    EXPECT_EQ(back.radius, node.radius);
    EXPECT_LT(length(back.normal - node.normal), 1e-12);
    EXPECT_EQ(back.cone, node.cone);
    EXPECT_EQ(back.triangles, node.triangles);
    EXPECT_EQ(back.color, node.color);
  }
}

TEST(PointNode, ConesAndCurvaturesAreRoundedAsPromised) {
  for (double sine = 0; sine < 1; sine += 1e-3) EXPECT_GE(decode_cone_sine(encode_cone(sine, false)), sine);
  EXPECT_EQ(encode_cone(0.5, true), kNoCone);
  for (double k = -1; k <= 1; k += 0.013)
    for (double angle = 0; angle < 3.1; angle += 0.4) {
      const NodeCurvature back = decode_curvature(encode_curvature({k, 0.5 * k, angle}));
      EXPECT_NEAR(back.k1, k, 0.005 + 0.02 * std::abs(k));
      EXPECT_NEAR(back.angle, angle, std::numbers::pi / 500);
    }
  const Rgba8 color{200, 100, 7, 255};
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(decode_color(encode_color(color))[k], color[k], 5);
}

TEST(TreeShape, ParentsChildrenAndLeavesAgree) {
  for (std::uint64_t leaves = 1; leaves < 700; ++leaves) {
    const TreeShape shape(leaves);
    ASSERT_EQ(shape.leaves(), leaves);
    std::uint64_t next = 1;
    for (std::uint64_t node = 0; node < shape.nodes(); ++node) {
      if (shape.is_leaf(node)) {
        ASSERT_EQ(shape.leaf_node(shape.leaf_rank(node)), node);
        continue;
      }
      ASSERT_EQ(TreeShape::first_child(node), next);
      ASSERT_GE(shape.child_count(node), 2u);
      std::uint64_t rank = shape.leaves_below(node).first;
      for (std::uint64_t k = 0; k < shape.child_count(node); ++k, ++next) {
        ASSERT_EQ(TreeShape::parent(next), node);
        ASSERT_TRUE(TreeShape::is_below(next, node));
        ASSERT_EQ(shape.leaves_below(next).first, rank) << "a depth-first walk meets the leaves in order";
        rank = shape.leaves_below(next).last;
      }
      ASSERT_EQ(rank, shape.leaves_below(node).last);
    }
    ASSERT_EQ(next, shape.nodes());
    ASSERT_EQ(shape.leaves_below(0).size(), leaves);
  }
}

std::vector<std::array<BlockVertex, 3>> random_leaf(std::mt19937& random, std::size_t size, bool joined) {
  std::vector<std::array<BlockVertex, 3>> leaf(size);
  const auto vertex = [&] {
    BlockVertex v;
    for (auto& x : v.position) x = static_cast<std::uint32_t>(1000 + random() % 5000);
    v.normal = encode_normal(random_direction(random));
    v.color = {static_cast<std::uint8_t>(random()), 2, 3, 255};
    return v;
  };
  for (std::size_t i = 0; i < size; ++i) {
    for (auto& v : leaf[i]) v = vertex();
    if (!joined || i == 0) continue;
    const auto& other = leaf[random() % i];  // across any edge of any earlier one, beginning with any corner
    const std::size_t edge = random() % 3, turn = random() % 3;
    leaf[i][turn] = other[(edge + 1) % 3], leaf[i][(turn + 1) % 3] = other[edge];
  }
  return leaf;
}

TEST(MeshBlock, HoldsItsLeavesTriangles) {
  for (int seed = 0; seed < 50; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    BlockBuilder builder(true);
    std::vector<std::vector<std::array<BlockVertex, 3>>> leaves;
    std::vector<std::uint8_t> counts;
    for (std::size_t i = 0; i < 1 + random() % kBlockLeaves; ++i) {
      leaves.push_back(random_leaf(random, 1 + random() % 4, random() % 4 != 0));
      counts.push_back(static_cast<std::uint8_t>(leaves.back().size()));
      builder.add_leaf(leaves.back());
    }
    const std::string bytes = builder.bytes();
    MeshBlock block;
    ASSERT_TRUE(decode_block(bytes, counts, block));
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      ASSERT_EQ(block.leaf_starts[i + 1] - block.leaf_starts[i], counts[i]);
      // Triangles of a leaf may change places, and begin with another corner.
      for (const auto& t : leaves[i]) {
        bool found = false;
        for (std::size_t k = block.leaf_starts[i]; k < block.leaf_starts[i + 1]; ++k)
          for (std::size_t turn = 0; turn < 3; ++turn) {
            const auto& v = block.triangles[k];
            found = found || (block.vertices[v[turn]] == t[0] && block.vertices[v[(turn + 1) % 3]] == t[1] &&
                              block.vertices[v[(turn + 2) % 3]] == t[2]);
          }
        EXPECT_TRUE(found);
      }
    }
    for (std::size_t n = 0; n < bytes.size(); ++n)
      EXPECT_FALSE(decode_block(std::span(bytes).first(n), counts, block)) << n;
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = bytes;
      damaged[random() % damaged.size()] = static_cast<char>(random());
      if (!decode_block(damaged, counts, block)) continue;
      for (const auto& t : block.triangles)
        for (const std::uint16_t v : t) EXPECT_LT(v, block.vertices.size());
    }
  }
}

}  // namespace
}  // namespace dupin
