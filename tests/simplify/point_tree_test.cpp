#include "../../simplify/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <unistd.h>

#include "../../core/parallel.h"
#include "../../simplify/bounding_sphere.h"
#include "../../simplify/leaf_clusters.h"
#include "../../simplify/point_tree_bytes.h"
#include "../../simplify/point_tree_layout.h"
#include "meshes.h"

namespace dupin {
namespace {

using Tree = std::shared_ptr<const PointTree>;

Tree tree_of(const PolygonMesh& mesh, PointTreeKind kind = PointTreeKind::pop) {
  PointTreeOptions options;
  options.kind = kind;
  const auto tree = build_point_tree(mesh, options);
  EXPECT_TRUE(tree.ok()) << tree.status().message;
  return tree.ok() ? *tree : nullptr;
}

EncodedNode node_at(const PointTree& tree, std::uint64_t i) {
  const auto node = tree.nodes(i, 1);
  EXPECT_EQ(node.size(), 1u);
  return node.empty() ? EncodedNode{} : node[0];
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

Vec3 grid_position(const BlockVertex& v) {
  return {double(v.position[0]), double(v.position[1]), double(v.position[2])};
}

/// Every triangle of the tree with the rank of its leaf.
template <class F>
void each_triangle(const PointTree& tree, F&& use) {
  MeshBlock block;
  for (std::size_t b = 0; b < tree.block_count(); ++b) {
    ASSERT_TRUE(tree.block(b, block));
    for (std::size_t leaf = 0; leaf + 1 < block.leaf_starts.size(); ++leaf)
      for (std::size_t t = block.leaf_starts[leaf]; t < block.leaf_starts[leaf + 1]; ++t)
        use(b * kBlockLeaves + leaf, std::array<BlockVertex, 3>{block.vertices[block.triangles[t][0]],
                                                                block.vertices[block.triangles[t][1]],
                                                                block.vertices[block.triangles[t][2]]});
  }
}

/// Spheres contain what is below them, and cones every normal, as they are decoded.
void expect_bounds_hold(const PointTree& tree) {
  const TreeShape& shape = tree.shape();
  for (std::uint64_t i = 1; i < shape.nodes(); ++i) {
    const EncodedNode child = node_at(tree, i), parent = node_at(tree, TreeShape::parent(i));
    ASSERT_LE(distance(node_center(parent), node_center(child)) + node_radius(child), node_radius(parent))
        << "node " << i;
    if (node_cone(parent) == kNoCone) continue;
    ASSERT_NE(node_cone(child), kNoCone);
    ASSERT_LE(angle_between(node_normal(parent), node_normal(child)) +
                  std::asin(decode_cone_sine(node_cone(child))),
              std::asin(decode_cone_sine(node_cone(parent))))
        << "node " << i;
  }
  each_triangle(tree, [&](std::uint64_t rank, const std::array<BlockVertex, 3>& t) {
    const EncodedNode leaf = node_at(tree, shape.leaf_node(rank));
    for (const BlockVertex& v : t)
      ASSERT_LE(distance(grid_position(v), node_center(leaf)), node_radius(leaf) * (1 + 1e-12) + 1e-12);
    const Vec3 n =
        cross(grid_position(t[1]) - grid_position(t[0]), grid_position(t[2]) - grid_position(t[0]));
    if (node_cone(leaf) == kNoCone || length(n) == 0) return;
    ASSERT_LE(angle_between(n, node_normal(leaf)), std::asin(decode_cone_sine(node_cone(leaf))));
  });
}

/// The mesh's triangles by their corners' places on the tree's grid.
std::multiset<std::array<std::uint32_t, 9>> triangles_on_grid(const PolygonMesh& mesh,
                                                              const PointTree& tree) {
  std::multiset<std::array<std::uint32_t, 9>> result;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    std::array<std::array<std::uint32_t, 3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 g = rounded_to_grid(tree.info().grid.to_grid(mesh.positions[mesh.corners[i + k]]));
      p[k] = {static_cast<std::uint32_t>(g.x), static_cast<std::uint32_t>(g.y),
              static_cast<std::uint32_t>(g.z)};
    }
    std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
    result.insert({p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2], p[2][0], p[2][1], p[2][2]});
  }
  return result;
}

void expect_same_triangles(const PolygonMesh& mesh, const PointTree& tree) {
  auto missing = triangles_on_grid(mesh, tree);
  std::size_t strange = 0;
  each_triangle(tree, [&](std::uint64_t, const std::array<BlockVertex, 3>& t) {
    std::array<std::array<std::uint32_t, 3>, 3> p{t[0].position, t[1].position, t[2].position};
    std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
    const auto found =
        missing.find({p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2], p[2][0], p[2][1], p[2][2]});
    if (found == missing.end())
      ++strange;
    else
      missing.erase(found);
  });
  EXPECT_EQ(strange, 0u);
  EXPECT_TRUE(missing.empty()) << missing.size() << " triangles are missing";
}

TEST(LeafClusters, AreOfAdjacentTrianglesAndNearlyFull) {
  const PolygonMesh mesh = test::ball(60);
  const TreeMesh source(mesh);
  const std::vector<LeafCluster> clusters = cluster_triangles(source);
  std::vector<int> seen(source.size(), 0);
  for (const LeafCluster& c : clusters) {
    ASSERT_GE(c.size, 1u);
    ASSERT_LE(c.size, kMostLeafTriangles);
    std::set<std::uint32_t> reached{c.triangles[0]};
    for (std::uint32_t i = 0; i < c.size; ++i) ++seen[c.triangles[i]];
    for (std::uint32_t round = 0; round < c.size; ++round)
      for (std::uint32_t i = 0; i < c.size; ++i)
        for (const std::uint32_t other : std::set<std::uint32_t>(reached)) {
          int shared = 0;
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) shared += source.vertex(c.triangles[i], a) == source.vertex(other, b);
          if (shared >= 2) reached.insert(c.triangles[i]);
        }
    EXPECT_EQ(reached.size(), c.size) << "joined by edges";
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
  EXPECT_LT(static_cast<double>(clusters.size()), static_cast<double>(source.size()) / 3.5);
}

TEST(TreeMesh, KnowsWhatIsClosed) {
  const auto closed = [](const PolygonMesh& mesh) {
    const TreeMesh tree(mesh);
    return std::count(tree.closed.begin(), tree.closed.end(), true);
  };
  const PolygonMesh ball = test::ball(10);
  const auto all = static_cast<std::ptrdiff_t>(ball.corners.size() / 3);
  EXPECT_EQ(closed(ball), all);
  EXPECT_EQ(closed(test::terrain(5)), 0);
  EXPECT_EQ(closed(test::joined(ball, test::terrain(5))), all);
  PolygonMesh inside_out = ball;
  for (std::size_t i = 0; i < inside_out.corners.size(); i += 3)
    std::swap(inside_out.corners[i], inside_out.corners[i + 1]);
  EXPECT_EQ(closed(inside_out), 0);
  PolygonMesh holed = ball;
  holed.corners.resize(holed.corners.size() - 3);
  EXPECT_EQ(closed(holed), 0);
  PolygonMesh split;  // every triangle with vertices of its own, as in STL
  for (const std::uint32_t v : ball.corners)
    split.corners.push_back(static_cast<std::uint32_t>(split.positions.size())),
        split.positions.push_back(ball.positions[v]);
  EXPECT_EQ(closed(split), all);
}

TEST(PointTree, BoundsHoldAndNoTriangleIsLost) {
  for (const PolygonMesh& mesh : {test::ball(40), test::terrain(33), test::box(), test::soup(500, 1),
                                  test::joined(test::ball(9, 0.3, {2, 0, 0}), test::terrain(7))}) {
    const Tree tree = tree_of(mesh);
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->info().triangles, mesh.corners.size() / 3);
    EXPECT_TRUE(tree->verify().ok());
    expect_bounds_hold(*tree);
    expect_same_triangles(mesh, *tree);
  }
}

TEST(PointTree, AWholeQSplatTreeHoldsItsVertices) {
  const PolygonMesh mesh = test::ball(30);
  const Tree tree = tree_of(mesh, PointTreeKind::qsplat);
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->info().leaves, mesh.positions.size());
  EXPECT_EQ(tree->info().triangles, 0u);
  expect_bounds_hold(*tree);
  // Spheres of vertices that are joined touch.
  std::map<std::array<double, 3>, double> radius;
  for (std::uint64_t rank = 0; rank < tree->info().leaves; ++rank) {
    const EncodedNode leaf = node_at(*tree, tree->shape().leaf_node(rank));
    const Vec3 c = node_center(leaf);
    radius[{c.x, c.y, c.z}] = node_radius(leaf);
  }
  const auto place = [&](std::uint32_t v) {
    return rounded_to_grid(tree->info().grid.to_grid(mesh.positions[v]));
  };
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vec3 a = place(mesh.corners[i]), b = place(mesh.corners[i % 3 == 2 ? i - 2 : i + 1]);
    ASSERT_GE((radius.at({a.x, a.y, a.z}) + radius.at({b.x, b.y, b.z})) * (1 + 1e-12), distance(a, b));
  }
}

TEST(PointTree, IsTheSameForAnyNumberOfThreads) {
  const PolygonMesh mesh = test::joined(test::ball(70), test::soup(3000, 5));
  for (const PointTreeKind kind : {PointTreeKind::pop, PointTreeKind::qsplat}) {
    const Tree several = tree_of(mesh, kind);
    set_thread_limit(1);
    const Tree one = tree_of(mesh, kind);
    set_thread_limit(0);
    EXPECT_TRUE(std::ranges::equal(one->bytes(), several->bytes()));
  }
}

TEST(PointTree, DegenerateMeshesHaveTrees) {
  PolygonMesh point_triangle;
  point_triangle.positions.assign(3, Vec3{1, 2, 3});
  point_triangle.corners = {0, 1, 2, 0, 0, 0};
  PolygonMesh line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.corners = {0, 1, 2, 0, 2, 2};
  PolygonMesh doubled = test::box();
  doubled.corners.insert(doubled.corners.end(), doubled.corners.begin(), doubled.corners.end());
  PolygonMesh one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.corners = {0, 1, 2};
  for (const PolygonMesh& mesh : {point_triangle, line, doubled, one})
    for (const PointTreeKind kind : {PointTreeKind::pop, PointTreeKind::qsplat}) {
      const Tree tree = tree_of(mesh, kind);
      ASSERT_TRUE(tree);
      EXPECT_TRUE(tree->verify().ok());
      expect_bounds_hold(*tree);
      if (kind == PointTreeKind::pop) expect_same_triangles(mesh, *tree);
    }
  EXPECT_EQ(build_point_tree(PolygonMesh{}, {}).status().code, StatusCode::unreadable);
  PolygonMesh huge = one;
  huge.positions[1].x = 1e300;
  EXPECT_EQ(build_point_tree(huge, {}).status().code, StatusCode::unreadable);
}

TEST(PointTree, PointsWithoutPolygonsGetNormalsAndReachTheirNeighbours) {
  PolygonMesh points = test::terrain(40);
  points.corners.clear();
  const Tree tree = tree_of(points);
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->info().kind, PointTreeKind::qsplat);
  EXPECT_EQ(tree->info().leaves, points.positions.size());
  expect_bounds_hold(*tree);
  for (std::uint64_t rank = 0; rank < tree->info().leaves; ++rank) {
    const EncodedNode leaf = node_at(*tree, tree->shape().leaf_node(rank));
    EXPECT_GT(std::abs(node_normal(leaf).z), 0.6);
    EXPECT_GT(node_radius(leaf) * tree->info().grid.step, 0.5 / 40);
  }
}

TEST(PointTree, NodesKnowTheCurvatureOfWhatTheyStandFor) {
  const double radius = 2.5;
  const Tree tree = tree_of(test::ball(120, radius));
  const double step = tree->info().grid.step;
  std::vector<double> errors;
  for (std::uint64_t i = 0; i < tree->shape().interior(); ++i) {
    const double r = node_radius(node_at(*tree, i)) * step;
    if (r > 0.3 * radius || node_normal(node_at(*tree, i)).z > 0.9) continue;
    const NodeCurvature k = decode_curvature(tree->curvature(i));
    errors.push_back(std::abs(k.k1 / r * -radius - 1));  // a ball bends away from its normal
    errors.push_back(std::abs(k.k2 / r * -radius - 1));
  }
  ASSERT_GT(errors.size(), 1000u);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.06);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.2);
}

TEST(PointTree, ColoursAndGroupsGoWithTheTriangles) {
  PolygonMesh mesh = test::terrain(20);
  mesh.groups = {{"left", Color{1, 0, 0, 1}}, {"right", std::nullopt}};
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    mesh.polygon_groups.push_back(mesh.positions[mesh.corners[i]].x < 0.5 ? 0 : 1);
  const Tree tree = tree_of(mesh);
  ASSERT_TRUE(tree->info().colors);
  ASSERT_EQ(tree->groups().size(), 2u);
  EXPECT_EQ(tree->groups()[0].name, "left");
  each_triangle(*tree, [&](std::uint64_t rank, const std::array<BlockVertex, 3>& t) {
    const bool left = tree->leaf_group(rank) == 0;
    EXPECT_EQ(t[0].color, left ? (Rgba8{255, 0, 0, 255}) : (Rgba8{196, 198, 203, 255}));
    const double x =
        std::min({t[0].position[0], t[1].position[0], t[2].position[0]}) * tree->info().grid.step;
    EXPECT_EQ(left, x < 0.499);
  });
}

// ---- files

class PointTreeFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("dupin-tree-" + std::to_string(::getpid()));
};

TEST_F(PointTreeFile, ComesBackAsItWent) {
  PointTreeOptions options;
  options.source = {"a part", "mm", 25.4};
  const auto tree = build_point_tree(test::ball(50), options);
  ASSERT_TRUE(tree.ok());
  ASSERT_TRUE(write_point_tree(**tree, path("ball.dpt")).ok());
  const auto back = open_point_tree(path("ball.dpt"));
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_TRUE(std::ranges::equal((*back)->bytes(), (*tree)->bytes()));
  EXPECT_TRUE((*back)->verify().ok());
  EXPECT_EQ((*back)->info().source.name, "a part");
  EXPECT_EQ((*back)->info().source.scale, 25.4);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
      << "no temporary file is left";
  EXPECT_FALSE(write_point_tree(**tree, path("no/such/folder/x.dpt")).ok());
  EXPECT_FALSE(open_point_tree(path("missing.dpt")).ok());
  EXPECT_FALSE(open_point_tree(folder_.string()).ok());
}

Result<Tree> tree_from(std::string bytes) {
  return PointTree::from_bytes(std::make_shared<OwnedBytes>(std::move(bytes), false));
}

/// The header's checksum made right again, so that the damage reaches what is behind it.
void reseal(std::string& bytes) {
  PointTreeHeader h;
  std::memcpy(&h, bytes.data(), sizeof h);
  h.checksum = page_checksum(std::span(bytes).first(sizeof h - sizeof h.checksum));
  std::memcpy(bytes.data(), &h, sizeof h);
}
/// And those of the pages.
void reseal_pages(std::string& bytes) {
  PointTreeHeader h;
  std::memcpy(&h, bytes.data(), sizeof h);
  const auto paged = std::span(bytes).subspan(sizeof h, h.sections[kPages].offset - sizeof h);
  for (std::size_t i = 0; i < h.sections[kPages].size / 8; ++i) {
    const std::size_t first = i * kPointTreePage;
    const std::uint64_t sum =
        page_checksum(paged.subspan(first, std::min<std::size_t>(kPointTreePage, paged.size() - first)));
    std::memcpy(bytes.data() + h.sections[kPages].offset + 8 * i, &sum, 8);
  }
}

/// Whatever the bytes, looking at everything must be safe.
void walk(const PointTree& tree) {
  MeshBlock block;
  for (std::uint64_t i = 0; i < tree.info().nodes; ++i) {
    const auto node = tree.nodes(i, 1);
    if (!node.empty()) (void)decode(node[0]);
    (void)tree.curvature(i);
  }
  for (std::uint64_t i = 0; i < tree.info().leaves; ++i) EXPECT_LE(tree.leaf_group(i), tree.groups().size());
  for (std::size_t i = 0; i < tree.block_count(); ++i)
    if (tree.block(i, block)) {
      for (const auto& t : block.triangles)
        for (const std::uint16_t v : t) EXPECT_LT(v, block.vertices.size());
    }
}

PolygonMesh grouped_terrain() {
  PolygonMesh mesh = test::terrain(12);
  mesh.groups = {{"a", Color{}}, {"b", std::nullopt}};
  mesh.polygon_groups.assign(mesh.corners.size() / 3, 1);
  return mesh;
}

TEST_F(PointTreeFile, EveryFlippedBitIsNoticed) {
  const Tree tree = tree_of(grouped_terrain());
  const std::string good(tree->bytes().begin(), tree->bytes().end());
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes = good;
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << random() % 8);
    const Result<Tree> damaged = tree_from(bytes);
    EXPECT_FALSE(damaged.ok() && (*damaged)->verify().ok()) << "byte " << at;
    if (damaged.ok()) walk(**damaged);
  }
}

TEST_F(PointTreeFile, EveryTruncationIsRefused) {
  const Tree tree = tree_of(test::terrain(6));
  const std::string good(tree->bytes().begin(), tree->bytes().end());
  for (std::size_t n = 0; n < good.size(); n += 7) EXPECT_FALSE(tree_from(good.substr(0, n)).ok()) << n;
  EXPECT_FALSE(tree_from(good + "x").ok());
}

TEST_F(PointTreeFile, DamageUnderRightChecksumsIsSafe) {
  const Tree tree = tree_of(grouped_terrain());
  const std::string good(tree->bytes().begin(), tree->bytes().end());
  std::mt19937 random(4);
  int opened = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = good;
    for (std::size_t k = 1 + random() % 3; k > 0; --k) {
      const std::size_t within = trial % 2 ? sizeof(PointTreeHeader) : bytes.size();
      const std::size_t at = random() % (within - 8);
      const std::uint64_t words[] = {
          0, ~0ull, std::uint64_t{random()}, 0x7ff0000000000000u, bytes.size(), 1ull << 40};
      std::memcpy(bytes.data() + at, &words[random() % 6], 1 + random() % 8);
    }
    PointTreeHeader h;
    std::memcpy(&h, bytes.data(), sizeof h);
    const ByteRange pages = h.sections[kPages];
    if (pages.offset >= sizeof h && pages.offset <= bytes.size() &&
        pages.size <= bytes.size() - pages.offset &&
        pages.size / 8 * kPointTreePage < pages.offset - sizeof h + kPointTreePage)
      reseal_pages(bytes);
    reseal(bytes);
    const Result<Tree> damaged = tree_from(bytes);
    if (!damaged.ok()) continue;
    ++opened;
    walk(**damaged);
  }
  EXPECT_GT(opened, 500);
}

}  // namespace
}  // namespace dupin
