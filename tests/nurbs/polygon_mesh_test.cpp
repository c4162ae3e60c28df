#include "../../nurbs/polygon_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "../../core/parallel.h"
#include "../../nurbs/mesh_triangles.h"

namespace dupin {
namespace {

PolygonMesh one_polygon(std::vector<Vec3> points) {
  PolygonMesh mesh;
  mesh.positions = std::move(points);
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.corners.push_back(i);
  mesh.starts = {0, static_cast<std::uint32_t>(mesh.corners.size())};
  return mesh;
}

PolygonMesh cube() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  mesh.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  for (std::uint32_t i = 0; i <= 6; ++i) mesh.starts.push_back(4 * i);
  return mesh;
}

/// A fan of n triangles around the top of a cone.
PolygonMesh cone(std::uint32_t n) {
  PolygonMesh mesh;
  mesh.positions.push_back({0, 0, 0.2});
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({std::cos(a), std::sin(a), 0});
    mesh.corners.insert(mesh.corners.end(), {0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

/// Each triangle's area vector, against the polygon's: ears of a simple polygon neither overlap nor leave
/// anything out.
void expect_covers(const PolygonMesh& mesh) {
  const std::vector<std::uint32_t> triangles = triangulate(mesh);
  ASSERT_EQ(triangles.size(), 3 * (mesh.corners.size() - 2));
  const Vec3 whole = area_vector(mesh, 0);
  Vec3 sum;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const Vec3 a = mesh.positions[mesh.corners[triangles[i]]],
               b = mesh.positions[mesh.corners[triangles[i + 1]]],
               c = mesh.positions[mesh.corners[triangles[i + 2]]];
    const Vec3 n = cross(b - a, c - a);
    EXPECT_GE(dot(n, whole), -1e-12 * dot(whole, whole)) << "triangle " << i / 3 << " is turned over";
    sum += n;
  }
  EXPECT_LT(length(sum - whole), 1e-9 * length(whole));
}

TEST(PolygonMesh, CountsWhatItHolds) {
  const PolygonMesh mesh = cube();
  EXPECT_TRUE(check(mesh).ok());
  EXPECT_EQ(mesh.polygon_count(), 6u);
  EXPECT_EQ(triangle_count(mesh), 12u);
  EXPECT_EQ(face_count(mesh), 1u);
  EXPECT_EQ(face_count(PolygonMesh{}), 0u);
  EXPECT_EQ(loose_point_count(mesh), 0u);
  EXPECT_NEAR(bounding_box(mesh).diagonal(), std::sqrt(3.0), 1e-15);
}

TEST(PolygonMesh, EveryBrokenInvariantIsFound) {
  const auto refused = [](auto&& change) {
    PolygonMesh mesh = cube();
    change(mesh);
    return !check(mesh).ok();
  };
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.corners[3] = 8; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.starts[2] = m.starts[1] + 2; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.starts.back() = 23; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.starts[1] = 23; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.starts = {}, m.corners.pop_back(); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.positions[0].y = NAN; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.normals.resize(7); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.normals.resize(8, {INFINITY, 0, 0}); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.corner_normals.resize(24, 0); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.colors.resize(9); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.polygon_colors.resize(5); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.polygon_groups.resize(6, 0); }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.tags.creases = {{0, 8, 1}}; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.tags.corners = {{0, NAN}}; }));
  EXPECT_TRUE(refused([](PolygonMesh& m) { m.tags.holes = {6}; }));
  EXPECT_FALSE(refused([](PolygonMesh&) {}));
}

TEST(PolygonMesh, APartsPolygonsAreCheckedWithIt) {
  Model model;
  model.parts.emplace_back().polygons = cube();
  model.instances.emplace_back();
  EXPECT_TRUE(check(model).ok());
  EXPECT_EQ(face_instance_count(model), 1u);
  model.parts[0].polygons.corners[0] = 99;
  EXPECT_FALSE(check(model).ok());
}

TEST(MeshTriangles, ConcavePolygonsAreCoveredExactly) {
  expect_covers(one_polygon({{0, 0, 1}, {4, 0, 1}, {4, 3, 1}, {2, 1, 1}, {0, 3, 1}}));
  expect_covers(
      one_polygon({{0, 0, 0}, {0, 5, 0}, {0, 5, 5}, {0, 4, 5}, {0, 4, 1}, {0, 1, 1}, {0, 1, 5}, {0, 0, 5}}));
  // Points on straight sides, and one that is there twice.
  expect_covers(
      one_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {1, 1, 0}, {0, 1, 0}}));
}

TEST(MeshTriangles, RandomStarsAreCoveredExactly) {
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> radius(0.2, 1);
    const int n = 4 + seed;
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n, r = radius(random);
      points.push_back({r * std::cos(a), r * std::sin(a), 0.3 * r * std::cos(a)});  // in a tilted plane
    }
    SCOPED_TRACE(seed);
    expect_covers(one_polygon(points));
  }
}

TEST(MeshTriangles, PolygonsThatNoEarCanBeCutFromStillMakeTheirTriangles) {
  const PolygonMesh crossed = one_polygon({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(triangulate(crossed).size(), 6u);
  const PolygonMesh point = one_polygon(std::vector<Vec3>(5, Vec3{1, 2, 3}));
  EXPECT_EQ(triangulate(point).size(), 9u);
  // A comb of many teeth, which naive ear cutting takes its square of time for.
  std::vector<Vec3> comb;
  for (int i = 0; i < 20000; ++i)
    comb.push_back({double(i), i % 2 ? 1.0 : 5.0, 0}), comb.push_back({i + 0.5, 0, 0});
  EXPECT_EQ(triangulate(one_polygon(comb)).size(), 3 * (comb.size() - 2));
}

TEST(MeshTriangles, ACubeStaysSharpAndAConeIsSmooth) {
  const PolygonMesh box = cube();
  const TriangleMesh drawn = to_triangle_mesh(box, {0.5, 0.5, 0.5});
  EXPECT_EQ(drawn.positions.size(), 24u);
  EXPECT_EQ(drawn.triangles.size(), 36u);
  for (std::size_t i = 0; i < drawn.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      const auto& p = drawn.positions[drawn.triangles[i + k]];
      return Vec3{p[0], p[1], p[2]};
    };
    const auto& n = drawn.normals[drawn.triangles[i]];
    const Vec3 face = normalized(cross(at(1) - at(0), at(2) - at(0)));
    EXPECT_NEAR(dot(face, Vec3{n[0], n[1], n[2]}), 1, 1e-6);
    EXPECT_GT(dot(face, at(0)), 0) << "outwards";
  }
  for (const std::uint32_t n : {8U, 31U, 33U, 1000U}) {
    const std::vector<std::array<float, 3>> normals = corner_normals(cone(n));
    EXPECT_NEAR(normals[0][2], 1, 1e-4) << n << ": the top's normal is the axis";
    EXPECT_EQ(to_triangle_mesh(cone(n), {}).positions.size(), n + 1) << n;
  }
}

TEST(MeshTriangles, NormalsOfTheFileGoFirst) {
  PolygonMesh mesh = one_polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  mesh.normals = {{0, 3, 4}, {0, 0, 0}, {0, 0, 1}};
  const auto normals = corner_normals(mesh);
  EXPECT_NEAR(normals[0][1], 0.6, 1e-6);
  EXPECT_EQ(normals[1], (std::array<float, 3>{0, 0, 1})) << "none given: the triangle's own";
  mesh.corner_normals = {PolygonMesh::kNoNormal, 0, 0};
  EXPECT_EQ(corner_normals(mesh)[0], (std::array<float, 3>{0, 0, 1}));
  EXPECT_NEAR(corner_normals(mesh)[2][2], 0.8, 1e-6);
}

TEST(MeshTriangles, ResultsDoNotDependOnTheNumberOfThreads) {
  const PolygonMesh mesh = cone(50000);
  const TriangleMesh several = to_triangle_mesh(mesh, {});
  set_thread_limit(1);
  const TriangleMesh one = to_triangle_mesh(mesh, {});
  set_thread_limit(0);
  EXPECT_EQ(one.normals, several.normals);
  EXPECT_EQ(one.triangles, several.triangles);
}

}  // namespace
}  // namespace dupin
