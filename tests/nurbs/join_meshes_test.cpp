#include "../../nurbs/join_meshes.h"

#include <gtest/gtest.h>

namespace dupin {
namespace {

constexpr Rgba8 kPlain{1, 2, 3, 255}, kRed{255, 0, 0, 255}, kBlue{0, 0, 255, 255};

PolygonMesh triangle(double x) {
  PolygonMesh mesh;
  mesh.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}};
  mesh.corners = {0, 1, 2};
  return mesh;
}
PolygonMesh square(double x) {
  PolygonMesh mesh = triangle(x);
  mesh.positions.push_back({x, 1, 1});
  mesh.corners = {0, 1, 2, 3};
  mesh.starts = {0, 4};
  return mesh;
}

TEST(JoinMeshes, TrianglesStayTrianglesWithTheirGroups) {
  PolygonMesh all;
  for (int i = 0; i < 3; ++i) append(all, triangle(i), kPlain);
  EXPECT_TRUE(check(all).ok());
  EXPECT_TRUE(all.all_triangles());
  EXPECT_EQ(all.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(all.polygon_groups, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(all.groups.size(), 3u);
}

TEST(JoinMeshes, PolygonsOfAnySizeFollowEachOther) {
  for (const bool square_first : {false, true}) {
    PolygonMesh all;
    append(all, square_first ? square(0) : triangle(0), kPlain);
    append(all, square_first ? triangle(5) : square(5), kPlain);
    ASSERT_TRUE(check(all).ok()) << check(all).message;
    ASSERT_EQ(all.polygon_count(), 2u);
    EXPECT_EQ(all.corner_count(0), square_first ? 4u : 3u);
    EXPECT_EQ(all.positions[all.polygon(1)[1]], (Vec3{6, 0, 0}));
  }
}

TEST(JoinMeshes, NormalsStayWithTheirCorners) {
  PolygonMesh by_vertex = triangle(0), by_corner = triangle(1);
  by_vertex.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  by_corner.normals = {{0, 0, -1}};
  by_corner.corner_normals = {0, PolygonMesh::kNoNormal, 0};
  PolygonMesh all = by_vertex;
  append(all, by_vertex, kPlain);
  EXPECT_TRUE(all.corner_normals.empty());
  append(all, triangle(2), kPlain);
  append(all, by_corner, kPlain);
  ASSERT_TRUE(check(all).ok()) << check(all).message;
  const auto normal = [&](std::size_t corner) { return all.normals[all.corner_normals[corner]]; };
  EXPECT_EQ(normal(4), (std::array<float, 3>{0, 1, 0}));
  EXPECT_EQ(all.corner_normals[7], PolygonMesh::kNoNormal);
  EXPECT_EQ(normal(9), (std::array<float, 3>{0, 0, -1}));
  EXPECT_EQ(all.corner_normals[10], PolygonMesh::kNoNormal);
}

TEST(JoinMeshes, ColorsOfAnyKindBecomeThoseOfTheFinest) {
  PolygonMesh by_group = triangle(0), by_polygon = triangle(1), by_vertex = triangle(2);
  by_group.groups = {{"red", Color{1, 0, 0, 1}}};
  by_polygon.polygon_colors = {kBlue};
  by_vertex.colors = {kRed, kBlue, kRed};
  PolygonMesh all = by_group;
  append(all, triangle(5), kPlain);
  EXPECT_TRUE(all.polygon_colors.empty());
  EXPECT_TRUE(all.groups[0].color && !all.groups[1].color);
  append(all, by_polygon, kPlain);
  EXPECT_EQ(all.polygon_colors, (std::vector<Rgba8>{kRed, kPlain, kBlue}));
  append(all, by_vertex, kPlain);
  ASSERT_TRUE(check(all).ok()) << check(all).message;
  EXPECT_EQ(all.colors, (std::vector<Rgba8>{kRed, kRed, kRed, kPlain, kPlain, kPlain, kBlue, kBlue, kBlue,
                                            kRed, kBlue, kRed}));
}

TEST(JoinMeshes, LoosePointsAndEmptyMeshes) {
  PolygonMesh points, all;
  points.positions = {{1, 2, 3}};
  append(all, PolygonMesh{}, kPlain);
  EXPECT_TRUE(all.empty());
  append(all, points, kPlain);
  append(all, triangle(0), kPlain);
  EXPECT_TRUE(check(all).ok()) << check(all).message;
  EXPECT_EQ(loose_point_count(all), 1u);
  EXPECT_EQ(all.corners[0], 1u);
}

}  // namespace
}  // namespace dupin
