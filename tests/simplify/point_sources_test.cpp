// Points of meshes and of exact faces.
#include "../../simplify/point_sources.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../render/hand_made.h"
#include "meshes.h"

namespace dupin {
namespace {

Part part_of(PolygonMesh mesh) {
  Part part;
  part.polygons = std::move(mesh);
  part.box = bounding_box(part.polygons);
  return part;
}

double area(const SurfacePoints& points) {
  double sum = 0;
  for (std::size_t t = 0; t < points.triangles.size(); t += 3) {
    const Vec3 &a = points.positions[points.triangles[t]], &b = points.positions[points.triangles[t + 1]],
               &c = points.positions[points.triangles[t + 2]];
    sum += length(cross(b - a, c - a)) / 2;
  }
  return sum;
}

double longest_edge(const SurfacePoints& points) {
  double longest = 0;
  for (std::size_t t = 0; t < points.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, distance(points.positions[points.triangles[t + k]],
                                           points.positions[points.triangles[t + (k + 1) % 3]]));
  return longest;
}

TEST(MeshPoints, AreTheVerticesWithTheirNormals) {
  const SurfacePoints points = *mesh_points(part_of(test::ball(20)));
  ASSERT_TRUE(check(points).ok());
  ASSERT_TRUE(points.is_mesh());
  EXPECT_EQ(points.normals.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_GT(dot(points.normals[i], normalized(points.positions[i])), 0.98);
}

TEST(MeshPoints, AreDenserOnRequestWithoutCracks) {
  const Part part = part_of(test::ball(8));
  const SurfacePoints coarse = *mesh_points(part), fine = *mesh_points(part, 0.1);
  EXPECT_GT(longest_edge(coarse), 0.3);
  EXPECT_LE(longest_edge(fine), 0.1);
  EXPECT_NEAR(area(fine), area(coarse), 1e-12 * area(coarse));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < fine.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(fine.triangles[t + k], fine.triangles[t + (k + 1) % 3]);
      ++edges[{a, b}];
    }
  for (const auto& [edge, count] : edges) ASSERT_EQ(count, 2) << edge.first << ' ' << edge.second;
  EXPECT_EQ(mesh_points(part, 1e-3, 10000).status().code, StatusCode::limit);
}

TEST(MeshPoints, TakeInPointsWithoutFaces) {
  PolygonMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const SurfacePoints points = *mesh_points(part_of(mesh));
  EXPECT_EQ(points.size(), 3U);
  EXPECT_FALSE(points.is_mesh());
}

TEST(DpPoints, LieOnTheSurfaceASpacingApart) {
  testing::HandMade sphere;
  sphere.add(testing::whole_sphere({0.3, 0.1, 2}, {1, 0, 0}, {0, 1, 0}, 2));
  const double spacing = 0.1;
  const SurfacePoints points = *dp_points(sphere.pieces(), spacing);
  ASSERT_TRUE(check(points).ok());
  // 4πr² in cells that are seen at up to 55° from their lines.
  EXPECT_GT(points.size(), 0.55 * 16 * 3.14159 / (spacing * spacing));
  EXPECT_LT(points.size(), 16 * 3.14159 / (spacing * spacing));
  const Vec3 middle{0.3, 0.1, 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(distance(points.positions[i], middle), 2, 1e-9);
    EXPECT_GT(dot(points.normals[i], (points.positions[i] - middle) / 2), 1 - 1e-9);
  }
  EXPECT_FALSE(dp_points(sphere.pieces(), 0).ok());
  EXPECT_EQ(dp_points(sphere.pieces(), 1e-3, 1000).status().code, StatusCode::limit);
}

TEST(DpPoints, OfNeighboringPiecesContinueEachOther) {
  testing::HandMade plate;
  plate.add(testing::plane_rectangle({0.5, 0.5, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1));
  plate.add(testing::plane_rectangle({1.5, 0.5, 0}, {0, 1, 0}, {-1, 0, 0}, 1, 1));
  const SurfacePoints points = *dp_points(plate.pieces(), 0.1);
  EXPECT_EQ(points.size(), 200U) << "on the lattice, none twice and none left out where the pieces meet";
}

TEST(Append, KeepsWhatOnlyOneHas) {
  SurfacePoints a{{{0, 0, 0}}, {}, {7}, {}, {}},
      b{{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}, {}, {1, 1, 2}, {0, 1, 2}};
  append(b, a);
  EXPECT_EQ(a.size(), 4U);
  EXPECT_EQ(a.colors, (std::vector<std::uint32_t>{7, 0, 0, 0}));
  EXPECT_EQ(a.faces, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(a.triangles, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_TRUE(a.normals.empty());
}

}  // namespace
}  // namespace dupin
