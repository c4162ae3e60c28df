// Differential points at mesh vertices: Taubin's curvatures against closed forms, and meshes that are not as
// they should be.
#include "../../sampling/mesh_points.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "../../core/parallel.h"
#include "../../sampling/point_sampler.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

void add_triangle(PolygonMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.corners.insert(mesh.corners.end(), {a, b, c});
}

/// A torus of radii 3 and 1, outward.
PolygonMesh torus(std::uint32_t around, std::uint32_t across) {
  PolygonMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / across, r = 3 + std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), std::sin(v)});
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      add_triangle(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(mesh, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

/// A square sheet of unit squares.
PolygonMesh sheet(std::uint32_t side) {
  PolygonMesh mesh;
  for (std::uint32_t i = 0; i <= side; ++i)
    for (std::uint32_t j = 0; j <= side; ++j) mesh.positions.push_back({i + 0.0, j + 0.0, 0});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (side + 1) + j; };
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      add_triangle(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(mesh, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

struct Made {
  PartPoints part;
  MeshPointLosses losses;
};
Made made_of(const PolygonMesh& mesh, MeshPointOptions options = {}) {
  Made made;
  made.part = mesh_points(mesh, options, made.losses);
  return made;
}

/// Every point of every triangle is held by the rectangle of one of its corners, seen along the triangle's
/// normal.
int uncovered(const PolygonMesh& mesh, const std::vector<DifferentialPoint>& points) {
  int holes = 0;
  for (std::size_t t = 0; t < mesh.corners.size() / 3; ++t) {
    const Vec3 a = mesh.positions[mesh.corners[3 * t]], b = mesh.positions[mesh.corners[3 * t + 1]],
               c = mesh.positions[mesh.corners[3 * t + 2]];
    const Vec3 n = normalized(cross(b - a, c - a));
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; i + j <= 8; ++j) {
        const Vec3 p = a + (b - a) * (i / 8.0) + (c - a) * (j / 8.0);
        holes += std::none_of(points.begin(), points.end(), [&](const DifferentialPoint& q) {
          const Vec3 d = p - q.position, flat = d - n * (dot(d, q.n()) / dot(n, q.n()));
          return dot(n, q.n()) > 0.5 && length(d) < 3 && std::abs(dot(flat, q.u)) <= q.half_u * (1 + 1e-9) &&
                 std::abs(dot(flat, q.v)) <= q.half_v * (1 + 1e-9);
        });
      }
  }
  return holes;
}

double worst_curvature(const PolygonMesh& mesh, MeshCurvature how) {
  MeshPointOptions options;
  options.curvature = how;
  double worst = 0;
  for (const DifferentialPoint& p : made_of(mesh, options).part.points) {
    const double r = std::hypot(p.position.x, p.position.y), k2 = -(r - 3) / r;
    const Vec3 n_exact{p.position.x / r * (r - 3), p.position.y / r * (r - 3), p.position.z};
    EXPECT_GT(dot(p.n(), n_exact), 0.99);
    worst = std::max({worst, std::abs(p.lambda_u + 1), std::abs(p.lambda_v - k2)});
  }
  return worst;
}

TEST(MeshPoints, FittedCurvaturesOfATorusComeToItsOwn) {
  double before = worst_curvature(torus(36, 12), MeshCurvature::fitted);
  for (const std::uint32_t n : {24U, 48U, 96U}) {
    const double worst = worst_curvature(torus(3 * n, n), MeshCurvature::fitted);
    EXPECT_LT(worst, 0.6 * before) << n;
    before = worst;
  }
  EXPECT_LT(before, 0.01);
}

TEST(MeshPoints, TaubinsCurvaturesDependOnHowEdgesAreSpread) {
  // Of a grid's six edges: for curvatures 1 and 0 his tensor has 1.245 and -0.245 (a matter of three
  // directions).
  for (const std::uint32_t n : {24U, 96U}) {
    const double worst = worst_curvature(torus(3 * n, n), MeshCurvature::taubin);
    EXPECT_GT(worst, 0.2);
    EXPECT_LT(worst, 0.6);
  }
}

TEST(MeshPoints, CurvaturesOfARegularFanAreThoseOfItsEdges) {
  // The apex of a flat hexagonal pyramid on a sphere: every edge has the same normal curvature 2 N·d / |d|².
  PolygonMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  const double height = 0.05;
  for (std::uint32_t i = 0; i < 6; ++i)
    mesh.positions.push_back({std::cos(kPi * i / 3), std::sin(kPi * i / 3), -height});
  for (std::uint32_t i = 0; i < 6; ++i) add_triangle(mesh, 0, 1 + i, 1 + (i + 1) % 6);
  for (const MeshCurvature how : {MeshCurvature::taubin, MeshCurvature::fitted}) {
    MeshPointOptions options;
    options.curvature = how;
    const DifferentialPoint p = made_of(mesh, options).part.points[0];
    const double k = -2 * height / (1 + height * height);
    EXPECT_NEAR(p.lambda_u, k, 1e-12);
    EXPECT_NEAR(p.lambda_v, k, 1e-12);
    EXPECT_NEAR(distance(p.n(), {0, 0, 1}), 0, 1e-12);
  }
}

TEST(MeshPoints, RectanglesHoldTheMiddlesOfEdgesAndCoverTheMesh) {
  const PolygonMesh mesh = torus(40, 16);
  for (const bool published : {false, true}) {
    MeshPointOptions options;
    options.hold_centroids = !published;
    const Made made = made_of(mesh, options);
    for (const auto& [a, b] : made.part.edges)
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        const DifferentialPoint& p = made.part.points[from];
        const Vec3 d = (made.part.points[to].position - p.position) * 0.5;
        // Projected not quite along the point's own normal.
        EXPECT_LE(std::abs(dot(d, p.u)), p.half_u * 1.1);
        EXPECT_LE(std::abs(dot(d, p.v)), p.half_v * 1.1);
      }
    if (!published) {
      EXPECT_EQ(uncovered(mesh, made.part.points), 0);
    }
  }
}

TEST(MeshPoints, AreNoSmallerThanEpsilonAndDeltaAllow) {
  MeshPointOptions options;
  options.delta = 2;
  options.epsilon = 0.1;
  for (const DifferentialPoint& p : made_of(torus(40, 16), options).part.points) {
    EXPECT_GE(p.half_u, half_extent(p.lambda_u, 0.1, 2));
    EXPECT_GE(p.half_v, half_extent(p.lambda_v, 0.1, 2));
    EXPECT_EQ(p.own_size,
              p.half_u > half_extent(p.lambda_u, 0.1, 2) || p.half_v > half_extent(p.lambda_v, 0.1, 2));
  }
}

TEST(MeshPoints, OfAPlaneAreFlatUpToItsBorder) {
  const PolygonMesh mesh = sheet(5);
  const Made made = made_of(mesh);
  ASSERT_EQ(made.part.points.size(), 36U);
  for (const DifferentialPoint& p : made.part.points) {
    EXPECT_EQ(p.lambda_u, 0);
    EXPECT_NEAR(distance(p.n(), {0, 0, 1}), 0, 1e-12);
  }
  EXPECT_EQ(uncovered(mesh, made.part.points), 0);
}

TEST(MeshPoints, ASoupOfTrianglesIsTheMeshThatItMakes) {
  const PolygonMesh mesh = torus(20, 8);
  PolygonMesh soup;
  for (const std::uint32_t v : mesh.corners) {
    soup.corners.push_back(static_cast<std::uint32_t>(soup.positions.size()));
    soup.positions.push_back(mesh.positions[v]);
  }
  const Made a = made_of(mesh), b = made_of(soup);
  ASSERT_EQ(a.part.points.size(), b.part.points.size());
  EXPECT_EQ(a.part.edges.size(), b.part.edges.size());
  double ours = 0, theirs = 0;
  for (const DifferentialPoint& p : a.part.points) ours += std::abs(p.lambda_u) + p.half_u;
  for (const DifferentialPoint& p : b.part.points) theirs += std::abs(p.lambda_u) + p.half_u;
  EXPECT_NEAR(ours, theirs, 1e-9 * ours);
}

TEST(MeshPoints, ACubesCornersHaveAPointForEachSide) {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 1.0 : -1, i & 2 ? 1.0 : -1, i & 4 ? 1.0 : -1});
  mesh.starts = {0, 4, 8, 12, 16, 20, 24};
  mesh.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  const Made made = made_of(mesh);
  EXPECT_EQ(made.part.points.size(), 24U);
  EXPECT_EQ(made.losses.split_vertices, 8U);
  for (const DifferentialPoint& p : made.part.points) {
    EXPECT_EQ(p.lambda_u, 0);
    EXPECT_NEAR(std::max({std::abs(p.n().x), std::abs(p.n().y), std::abs(p.n().z)}), 1, 1e-12);
    EXPECT_GT(dot(p.n(), p.position), 0.9) << "outward";
  }
  MeshPointOptions published;
  published.split_creases = false;
  EXPECT_EQ(made_of(mesh, published).part.points.size(), 8U);
}

TEST(MeshPoints, EdgesOfManyTrianglesKeepThemAll) {
  // Three sheets that meet in an edge, and one of them there twice.
  PolygonMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -0.5, 0.9}, {0.5, -0.5, -0.9}};
  add_triangle(mesh, 0, 1, 2);
  add_triangle(mesh, 0, 1, 3);
  add_triangle(mesh, 0, 1, 4);
  add_triangle(mesh, 0, 1, 2);
  const Made made = made_of(mesh);
  EXPECT_EQ(uncovered(mesh, made.part.points), 0);
  for (const DifferentialPoint& p : made.part.points)
    EXPECT_TRUE(is_finite(p.n()) && p.half_u > 0 && p.half_v > 0);
}

TEST(MeshPoints, WhatHasNoAreaIsCounted) {
  PolygonMesh mesh = sheet(2);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{9, 9, 9}, {20, 0, 0}, {21, 0, 0}, {22, 0, 0}});
  add_triangle(mesh, first + 1, first + 2, first + 3);  // on a line
  add_triangle(mesh, 0, 0, 1);
  const Made made = made_of(mesh);
  EXPECT_EQ(made.part.points.size(), 9U);
  EXPECT_EQ(made.losses.loose_vertices, 1U);
  EXPECT_EQ(made.losses.flat_triangles, 2U);
  EXPECT_EQ(made.losses.lost_vertices, 3U);
}

TEST(MeshPoints, APointsOnlyMeshHasNone) {
  Model model;
  model.parts.emplace_back().polygons.positions = {{0, 0, 0}, {1, 2, 3}};
  model.instances.emplace_back();
  PointSamplingOptions options;
  options.delta = 1;
  const auto scene = sample_points(model, options);
  ASSERT_TRUE(scene.ok());
  EXPECT_EQ(scene->count(), 0U);
  ASSERT_EQ(scene->parts[0].skipped.size(), 1U);
  ASSERT_EQ(scene->notes.size(), 1U);
  EXPECT_EQ(scene->notes[0].substr(0, 2), "2 ");
}

TEST(MeshPoints, AFanOfManyTrianglesTakesNoLongerThanItsSize) {
  PolygonMesh mesh;
  mesh.positions.push_back({});
  constexpr std::uint32_t kBlades = 100000;
  for (std::uint32_t i = 0; i < kBlades; ++i)
    mesh.positions.push_back({std::cos(2 * kPi * i / kBlades), std::sin(2 * kPi * i / kBlades), 0});
  for (std::uint32_t i = 0; i < kBlades; ++i) add_triangle(mesh, 0, 1 + i, 1 + (i + 1) % kBlades);
  for (std::uint32_t i = 0; i < kBlades / 2; ++i) add_triangle(mesh, 0, 1, 2);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GE(made_of(mesh).part.points.size(), kBlades + 1);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20)
      << "not quadratic";
}

TEST(MeshPoints, AreTheSameForAnyNumberOfThreads) {
  set_thread_limit(1);
  const Made one = made_of(torus(60, 20));
  set_thread_limit(0);
  const Made many = made_of(torus(60, 20));
  ASSERT_EQ(one.part.points.size(), many.part.points.size());
  EXPECT_EQ(one.part.edges, many.part.edges);
  for (std::size_t i = 0; i < one.part.points.size(); ++i)
    EXPECT_EQ(one.part.points[i].u, many.part.points[i].u);
}

TEST(MeshPoints, OfCertifiedSamplingAreListedAsSkipped) {
  Model model;
  model.parts.emplace_back().polygons = sheet(2);
  model.instances.emplace_back();
  PointSamplingOptions options;
  options.method = PointMethod::certified;
  options.tolerance = 1;
  const auto scene = sample_points(model, options);
  ASSERT_TRUE(scene.ok());
  ASSERT_EQ(scene->parts[0].skipped.size(), 1U);
}

}  // namespace
}  // namespace dupin
