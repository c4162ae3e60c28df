// Edges between faces: no ray gets through, whatever the file's own edges are off.
#include "../../sampling/part_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "../../cad_import/cad_import.h"
#include "../../sampling/sampler.h"
#include "../cad_import/files.h"

namespace dupin {
namespace {

Curve2 line2(Vec2 origin, Vec2 direction) {
  return {LineOf<Vec2>{origin, direction}};
}

/// Two planes, z = 0 for y < 0 and one that rises by `angle` for y > 0, and an edge that is off both.
Part roof(double angle, Vec3 off, double tolerance) {
  Part part;
  part.surfaces.push_back({Plane{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}});
  const Vec3 up{0, std::cos(angle), std::sin(angle)};
  part.surfaces.push_back({Plane{{{0, 0, 0}, {1, 0, 0}, up, cross(Vec3{1, 0, 0}, up)}}});
  Edge edge;
  edge.curve = Curve3{LineOf<Vec3>{off, {1, 0, 0}}};
  edge.t1 = 10, edge.tolerance = tolerance;
  part.edges.push_back(edge);
  for (std::uint32_t f = 0; f < 2; ++f) {
    Face face;
    face.surface = f;
    Trim trim;
    trim.edge = 0, trim.reversed = f == 0;
    trim.pcurve = line2({0, 0}, {1, 0});
    face.loops.push_back({trim});
    part.faces.push_back(face);
  }
  part.box.add(Vec3{0, -10, -10}), part.box.add(Vec3{10, 10, 10});
  return part;
}

TEST(PartEdges, AnEdgeOffItsFacesMovesToWhereTheyMeet) {
  const Part part = roof(1.2, {0, 0.01, 0.02}, 0.05);
  const PartEdges edges(part, [](const Box3&) { return 0.1; });
  const ConicArc3& arc = edges.chains()[0].arcs[0];
  for (const Vec3& p : {arc.p0, arc.p2}) EXPECT_LT(std::hypot(p.y, p.z), 1e-12);
  EXPECT_TRUE(arc.line);
  EXPECT_NEAR(edges.moved(0), std::hypot(0.01, 0.02), 1e-12);
}

TEST(PartEdges, WhereFacesGoOnSmoothlyBothReachOverTheGap) {
  const Part part = roof(0.001, {0, 0, 0.02}, 0.05);
  const PartEdges edges(part, [](const Box3&) { return 0.1; });
  EXPECT_EQ(edges.moved(0), 0);
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto reach = edges.reach(f, 0);
    ASSERT_EQ(reach.size(), 1u);
    // Outwards: the first face lies at y < 0.
    for (const Vec3& r : reach[0].by) EXPECT_GT(r.y * (f == 0 ? 1 : -1), 2 * 0.02);
    EXPECT_EQ(reach[0].own, 0) << "planes are drawn exactly";
  }
}

TEST(PartEdges, ExactEdgesAreLeftAlone) {
  const Part part = roof(1.2, {}, 1e-7);
  const PartEdges edges(part, [](const Box3&) { return 0.1; });
  EXPECT_EQ(edges.moved(0), 0);
  EXPECT_TRUE(edges.reach(0, 0).empty());
  const PartEdges fine(part, [](const Box3&) { return 1e-6; });
  EXPECT_EQ(fine.moved(0), 0);
  for (const ArcReach& r : fine.reach(0, 0)) EXPECT_EQ(length(r.by[1]), 0);
}

/// Where the line meets the DP's region, if it does within `reach` of its origin.
bool hits(const PartDps& part, const QuadricDp& dp, const Vec3& origin, const Vec3& direction, double reach) {
  const Vec3 d = origin - dp.origin, n = dp.n();
  const Vec3 o{dot(d, dp.u), dot(d, dp.v), dot(d, n)},
      r{dot(direction, dp.u), dot(direction, dp.v), dot(direction, n)};
  const double C = quadric_value(dp, o), B = dot(quadric_gradient(dp, o), r);
  const double A = -0.5 * (dp.lambda_u * r.x * r.x + dp.lambda_v * r.y * r.y) - dp.a * r.x * r.z -
                   dp.b * r.y * r.z - 0.5 * dp.c * r.z * r.z;
  double t[2];
  int count = 0;
  const double disc = B * B - 4 * A * C;
  if (disc < 0) return false;
  const double q = -0.5 * (B + std::copysign(std::sqrt(disc), B));
  if (q != 0) t[count++] = C / q;
  if (A != 0) t[count++] = q / A;
  for (int i = 0; i < count; ++i)
    if (std::abs(t[i]) <= reach && region_contains(part, dp, o + r * t[i])) return true;
  return false;
}

struct EdgeUse {
  const Face* face;
  const Trim* trim;
};

Vec3 outward_normal(const Part& part, const EdgeUse& use, double t) {
  const Vec2 uv = point_at(use.trim->pcurve, t);
  const SurfaceJet jet = evaluate(part.surfaces[use.face->surface], uv.x, uv.y, 1);
  return normalized(cross(jet.pu, jet.pv)) * (use.face->reversed ? -1.0 : 1.0);
}

/// Lines through points of edges that two faces share, crossing both at more than a grazing angle.
void expect_no_gaps(const std::string& path, double tolerance_of_diagonal) {
  SCOPED_TRACE(path);
  Result<Model> read = test::import_file(path);
  ASSERT_TRUE(read.ok()) << read.status().message;
  SamplingOptions options;
  options.tolerance = tolerance_of_diagonal * bounding_box(*read).diagonal();
  options.normal_tolerance = 0.5 * 3.14159265358979323846 / 180;
  Result<DpScene> scene = sample_quadric_dps(*read, options);
  ASSERT_TRUE(scene.ok());
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr double kLeastSine = 0.2;
  int lines = 0, through = 0;
  for (std::size_t p = 0; p < read->parts.size(); ++p) {
    const Part& part = read->parts[p];
    std::vector<std::vector<EdgeUse>> uses(part.edges.size());
    for (const Face& face : part.faces)
      for (const Loop& loop : face.loops)
        for (const Trim& trim : loop) uses[trim.edge].push_back({&face, &trim});
    for (std::size_t e = 0; e < part.edges.size(); ++e) {
      const Edge& edge = part.edges[e];
      if (uses[e].size() != 2 || !edge.curve || uses[e][0].face == uses[e][1].face) continue;
      // Beside an edge shorter than the lines are off it a third face may be missed.
      if (distance(point_at(*edge.curve, edge.t0), point_at(*edge.curve, 0.5 * (edge.t0 + edge.t1))) <
          options.tolerance)
        continue;
      for (int i = 0; i < 40; ++i) {
        const double t = edge.t0 + (edge.t1 - edge.t0) * (0.5 + 0.48 * unit(rng));
        const Vec3 d = normalized(Vec3{unit(rng), unit(rng), unit(rng)});
        const double a = dot(d, outward_normal(part, uses[e][0], t)),
                     b = dot(d, outward_normal(part, uses[e][1], t));
        if (!(a * b > 0 && std::min(std::abs(a), std::abs(b)) > kLeastSine)) continue;
        const double near = 0.1 * options.tolerance;
        const Vec3 o = point_at(*edge.curve, t) + Vec3{unit(rng), unit(rng), unit(rng)} * (near * unit(rng));
        ++lines;
        bool hit = false;
        for (const QuadricDp& dp : scene->parts[p].dps)
          if (hits(scene->parts[p], dp, o, d, 20 * options.tolerance + 10 * edge.tolerance)) {
            hit = true;
            break;
          }
        through += !hit;
      }
    }
  }
  EXPECT_GT(lines, 50);
  EXPECT_EQ(through, 0) << "of " << lines;
}

TEST(PartEdges, NoLineGetsThroughBetweenFaces) {
  expect_no_gaps(test::sample("freeform.step"), 1e-3);
  expect_no_gaps(test::sample("bracket.step"), 1e-3);
}

TEST(PartEdges, NoLineGetsThroughBetweenFacesOfRealModels) {
  DUPIN_NEED_DATA(teapot, "nurbs/converted/teapot.step");
  expect_no_gaps(teapot, 2.5e-4);
  DUPIN_NEED_DATA(rods, "cad/occt/linkrods.step");
  expect_no_gaps(rods, 1e-3);
}

}  // namespace
}  // namespace dupin
