#include "../../nurbs/subdivision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "../../nurbs/cage_levels.h"
#include "../../nurbs/limit_caps.h"
#include "cages.h"

namespace dupin {
namespace {

using test::FanCage;

SubdivisionSurface surface_of(const PolygonMesh& cage, int levels = 6,
                              SubdivisionScheme scheme = SubdivisionScheme::automatic) {
  auto made = SubdivisionSurface::make(cage, {scheme, levels});
  EXPECT_TRUE(made.ok()) << made.status().message;
  return std::move(*made);
}

double diagonal(const PolygonMesh& cage) {
  return bounding_box(cage).diagonal();
}

struct Named {
  std::string name;
  PolygonMesh cage;
};

PolygonMesh with(PolygonMesh cage, const std::function<void(SubdivisionTags&)>& change) {
  change(cage.tags);
  return cage;
}

/// Every rule that there is: creases of both kinds, corners, darts, boundaries, holes, polygons of other
/// sizes, and vertices where surfaces touch.
std::vector<Named> cages_of_all_kinds() {
  const PolygonMesh cube = test::cube_cage(), grid = test::grid_cage(5, 6, false, 3),
                    ico = test::icosahedron_cage(), triangles = test::grid_cage(5, 5, true, 4);
  std::vector<Named> cages{{"cube", cube}, {"grid", grid}, {"icosahedron", ico}, {"triangles", triangles}};
  cages.push_back({"creased", with(cube, [](auto& t) {
                     t.creases = {{4, 5, 10}, {5, 7, 10}, {7, 6, 10}, {6, 4, 10}};
                   })});
  cages.push_back({"semi-sharp", with(cube, [](auto& t) {
                     t.creases = {{4, 5, 1.5f}, {5, 7, 2}, {7, 6, 0.3f}, {6, 4, 1}};
                   })});
  cages.push_back({"dart", with(cube, [](auto& t) { t.creases = {{4, 5, 10}}; })});
  cages.push_back({"corners", with(cube, [](auto& t) { t.corners = {{0, 10}, {7, 2.5f}}; })});
  cages.push_back({"three creases meet", with(cube, [](auto& t) {
                     t.creases = {{0, 1, 10}, {0, 2, 10}, {0, 4, 10}};
                   })});
  cages.push_back({"chaikin", with(cube, [](auto& t) {
                     t.chaikin = true, t.creases = {{4, 5, 3}, {5, 7, 2}, {7, 6, 1}};
                   })});
  cages.push_back({"corners of a boundary",
                   with(grid, [](auto& t) { t.boundary = SubdivisionTags::Boundary::edges_and_corners; })});
  cages.push_back({"no boundary", with(grid, [](auto& t) { t.boundary = SubdivisionTags::Boundary::none; })});
  cages.push_back({"hole", with(cube, [](auto& t) { t.holes = {1}; })});
  cages.push_back({"creases of triangles", with(ico, [](auto& t) {
                     t.creases = {{0, 11, 10}, {0, 5, 10}, {1, 8, 1.7f}};
                   })});
  cages.push_back({"corners of triangles", with(triangles, [](auto& t) {
                     t.boundary = SubdivisionTags::Boundary::edges_and_corners;
                   })});
  cages.push_back({"a crease through triangles", with(test::torus_cage(8, 7, true, 5), [](auto& t) {
                     for (std::uint32_t i = 0; i < 8; ++i)
                       t.creases.push_back({7 * i, 7 * ((i + 1) % 8), 10});
                   })});
  cages.push_back(
      {"polygons",
       test::cage_of({{0, 0, 0}, {1, 0, 0}, {1.5, 1, 0.2}, {0.5, 1.8, 0}, {-0.5, 1, 0.1}, {0.5, 0.8, 2}},
                     {{4, 3, 2, 1, 0}, {0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 0, 5}})});
  cages.push_back(
      {"two cubes at an edge",
       test::cage_of(
           {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {0, -1, 0}, {0, -1, 1}},
           {{0, 1, 2, 3}, {0, 3, 5, 4}, {3, 0, 6, 7}})});
  return cages;
}

/// All parameters of a polygon that are multiples of 1/n.
template <class Visit>
void each_parameter(const SubdivisionSurface& surface, const PolygonMesh& cage, std::size_t polygon, int n,
                    const Visit& visit) {
  const bool loop = surface.scheme() == SubdivisionScheme::loop;
  const std::size_t corners = cage.corner_count(polygon), pieces = loop || corners == 4 ? 1 : corners;
  for (std::size_t piece = 0; piece < pieces; ++piece)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= (loop ? n - i : n); ++j) {
        if (piece + 1 < pieces && i == n) continue;
        visit(static_cast<double>(piece) + static_cast<double>(i) / n, static_cast<double>(j) / n);
      }
}

double nearest(const std::vector<Vec3>& points, const Vec3& p) {
  double least = 1e300;
  for (const Vec3& q : points) least = std::min(least, distance(p, q));
  return least;
}

TEST(SubdivisionSurface, GoesThroughTheLimitsOfUniformRefinement) {
  for (const auto& [name, cage] : cages_of_all_kinds()) {
    SCOPED_TRACE(name);
    const SubdivisionSurface surface = surface_of(cage);
    auto uniform = refine_cage(cage, {surface.scheme(), 4, false});
    ASSERT_TRUE(uniform.ok());
    int exact = 0;
    for (std::size_t f = 0; f < cage.polygon_count(); ++f)
      each_parameter(surface, cage, f, 8, [&](double u, double v) {
        const LimitJet at = surface.evaluate(f, u, v, 0);
        if (!is_finite(at.jet.p)) return;
        exact += at.exact;
        EXPECT_LT(nearest(uniform->limits, at.jet.p), 1e-14 * diagonal(cage)) << f << " " << u << " " << v;
      });
    EXPECT_GT(exact, 0);
  }
}

TEST(SubdivisionSurface, ARegularTorusIsTheSplineOfItsCage) {
  const int nu = 7, nv = 6;
  const PolygonMesh cage = test::torus_cage(nu, nv, false, 1);
  BsplineSurface spline;
  spline.degree_u = spline.degree_v = 3;
  spline.count_u = nu + 3, spline.count_v = nv + 3;
  for (int i = -3; i <= nu + 3; ++i) spline.knots_u.push_back(i);
  for (int j = -3; j <= nv + 3; ++j) spline.knots_v.push_back(j);
  for (int i = 0; i < nu + 3; ++i)
    for (int j = 0; j < nv + 3; ++j)
      spline.poles.push_back(
          cage.positions[static_cast<std::size_t>((i + nu - 1) % nu * nv + (j + nv - 1) % nv)]);
  const SubdivisionSurface surface = surface_of(cage, 3);
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const auto polygon = static_cast<std::size_t>(i * nv + j);
      const LimitJet limit = surface.evaluate(polygon, 0.3, 0.6, 3);
      const SurfaceJet jet = evaluate({spline}, i + 0.3, j + 0.6, 3);
      EXPECT_TRUE(limit.exact);
      const std::pair<Vec3, Vec3> pairs[] = {{limit.jet.p, jet.p},       {limit.jet.pu, jet.pu},
                                             {limit.jet.puv, jet.puv},   {limit.jet.pvv, jet.pvv},
                                             {limit.jet.puuu, jet.puuu}, {limit.jet.puvv, jet.puvv}};
      for (const auto& [a, b] : pairs) EXPECT_LT(distance(a, b), 1e-12);
    }
}

TEST(SubdivisionSurface, AgreesWithStamsEigenvectorsAroundEveryValence) {
  for (const bool triangles : {false, true})
    for (int valence = 3; valence <= 12; ++valence) {
      SCOPED_TRACE(std::to_string(valence) + (triangles ? " triangles" : " quads"));
      const FanCage fan(valence, triangles, static_cast<std::uint64_t>(valence));
      const SubdivisionSurface surface =
          surface_of(fan.mesh(), 10, triangles ? SubdivisionScheme::loop : SubdivisionScheme::catmull_clark);
      for (int level = 0; level <= 8; ++level)
        for (const Vec2 way :
             {Vec2{0.7, 0.2}, Vec2{0.31, 0.42}, Vec2{0.05, 0.55}, Vec2{1, 0}, Vec2{0.6, 0}}) {
          const Vec2 at = way * std::ldexp(1.0, -level);
          const LimitJet limit = surface.evaluate(0, at.x, at.y, 2);
          const SurfaceJet jet = fan.stam(at.x, at.y);
          ASSERT_TRUE(limit.exact);
          // Three triangles make the matrix defective, and its eigenvectors lose digits.
          EXPECT_LT(distance(limit.jet.p, jet.p), triangles && valence == 3 ? 1e-9 : 1e-12);
          EXPECT_LT(distance(limit.jet.pu, jet.pu), 1e-9 * length(jet.pu));
          const Curvature a = surface.curvature(0, at.x, at.y), b = principal_curvature(jet);
          const double tolerance = (level == 0 ? 1e-9 : 1e-5) * std::abs(b.k1);
          EXPECT_NEAR(a.k1, b.k1, tolerance) << level;
          EXPECT_NEAR(a.k2, b.k2, tolerance) << level;
        }
    }
}

TEST(SubdivisionSurface, SaysWhereCurvatureHasNoLimit) {
  const PolygonMesh cage = test::cube_cage();
  const SubdivisionSurface surface = surface_of(cage, 8);
  EXPECT_EQ(surface.curvature(0, 0, 0).kind, Curvature::Kind::undefined);
  EXPECT_EQ(surface.curvature(0, 1e-4, 1e-4).kind, Curvature::Kind::undefined);
  EXPECT_FALSE(surface.evaluate(0, 1e-4, 1e-4, 1).exact);
  EXPECT_NE(surface.curvature(0, 0.01, 0.01).kind, Curvature::Kind::undefined);
  // The limit normal at a cube's corner is its diagonal.
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Vec3 diagonal = normalized(cage.positions[cage.polygon(0)[corner]]);
    EXPECT_LT(distance(surface.corner_normal(0, corner), diagonal), 1e-12);
  }
}

TEST(SubdivisionSurface, ACubesCornerBendsAsItsExactPiecesSay) {
  // Beside a vertex of valence 3 curvatures tend to a finite limit only along each direction; OpenSubdiv's
  // default interpolants say -1.16 here.
  const SubdivisionSurface surface = surface_of(test::cube_cage(), 12);
  const Curvature k = surface.curvature(0, 1e-3, 1e-3);
  EXPECT_EQ(k.kind, Curvature::Kind::regular);
  EXPECT_NEAR(k.k1, -1.80, 0.01);
}

TEST(SubdivisionSurface, AHoleHasNoPoints) {
  const PolygonMesh cage = with(test::cube_cage(), [](auto& t) { t.holes = {2}; });
  const SubdivisionSurface surface = surface_of(cage);
  EXPECT_FALSE(is_finite(surface.evaluate(2, 0.5, 0.5, 1).jet.p));
  EXPECT_TRUE(is_finite(surface.evaluate(1, 0.5, 0.5, 1).jet.p));
  EXPECT_FALSE(is_finite(surface.evaluate(99, 0.5, 0.5, 1).jet.p));
}

TEST(SubdivisionSurface, RefusesWhatIsNoCage) {
  EXPECT_EQ(SubdivisionSurface::make({}).status().code, StatusCode::unreadable);
  EXPECT_EQ(SubdivisionSurface::make(test::cube_cage(), {SubdivisionScheme::loop, 5}).status().code,
            StatusCode::invalid_argument);
  EXPECT_EQ(SubdivisionSurface::make(test::cube_cage(), {SubdivisionScheme::automatic, 99}).status().code,
            StatusCode::invalid_argument);
  PolygonMesh twice = test::cage_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 1, 2}});
  EXPECT_EQ(SubdivisionSurface::make(twice).status().code, StatusCode::unreadable);
  PolygonMesh broken = test::cube_cage();
  broken.positions[3].y = std::nan("");
  EXPECT_FALSE(SubdivisionSurface::make(broken).ok());
}

TEST(SubdivisionPart, IsAValidModelWhoseNeighboursMeet) {
  for (const auto& [name, cage] : cages_of_all_kinds()) {
    SCOPED_TRACE(name);
    Model model;
    model.parts.push_back(surface_of(cage, 8).part());
    const Part& part = model.parts[0];
    const Status valid = check(model);
    EXPECT_TRUE(valid.ok()) << valid.message;
    ASSERT_FALSE(part.faces.empty());
    std::vector<int> uses(part.edges.size(), 0);
    for (const Face& face : part.faces)
      for (const Loop& loop : face.loops)
        for (const Trim& trim : loop) {
          ++uses[trim.edge];
          for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
            const Vec2 uv = point_at(trim.pcurve, t);
            EXPECT_LT(distance(point_at(part.surfaces[face.surface], uv.x, uv.y),
                               point_at(*part.edges[trim.edge].curve, t)),
                      1e-13 * diagonal(cage));
          }
        }
    for (std::size_t e = 0; e < uses.size(); ++e)
      EXPECT_TRUE(uses[e] == 2 || !part.edges[e].smooth) << "a smooth edge with " << uses[e] << " faces";
  }
}

TEST(SubdivisionPart, CreasesAndBoundariesAreFeatureLines) {
  const auto sharp_edges = [](const PolygonMesh& cage) {
    int count = 0;
    const Part part = surface_of(cage).part();
    for (const Edge& edge : part.edges) count += !edge.smooth;
    return count;
  };
  EXPECT_EQ(sharp_edges(test::cube_cage()), 0);
  EXPECT_GE(sharp_edges(with(test::cube_cage(), [](auto& t) { t.creases = {{4, 5, 10}}; })), 1);
  EXPECT_GE(sharp_edges(test::grid_cage(5, 6, false, 3)), 18);
}

/// How far caps are off the exact pieces beneath them.
void check_caps(const FanCage& fan) {
  auto levels = refine_cage(fan.mesh(), {SubdivisionScheme::automatic, 12, true});
  ASSERT_TRUE(levels.ok());
  const LimitForest forest = make_limit_forest(std::move(*levels));
  const CapHulls hulls(forest);
  const SubdivisionSurface fine = surface_of(fan.mesh(), 12);
  for (int level = 1; level <= 3; ++level) {
    std::uint32_t node = forest.roots[0];
    for (int l = 0; l < level; ++l) node = forest.nodes[node].first_child;
    const LimitCap cap = make_cap(forest, hulls, node);
    EXPECT_LT(cap.deviation, 0.2 * cap.size);
    double worst = 0, worst_normal = 0;
    for (int i = 0; i <= 32; ++i)
      for (int j = 0; j <= 32; ++j) {
        const Vec2 local{i / 32.0, j / 32.0};
        if (forest.corners() == 3 && local.x + local.y > 1) continue;
        const double h = forest.nodes[node].size();
        const LimitJet limit = fine.evaluate(0, local.x * h, local.y * h, 1);
        Vec3 d[3];
        evaluate_patch(cap.patch, local, 1, d);
        worst = std::max(worst, distance(d[0], limit.jet.p));
        const Vec3 a = cross(d[1], d[2]), b = cross(limit.jet.pu, limit.jet.pv);
        if (std::max(local.x, local.y) > 0.25)
          worst_normal = std::max(worst_normal, std::atan2(length(cross(a, b)), dot(a, b)));
      }
    EXPECT_LE(worst, cap.deviation);
    EXPECT_LE(worst_normal, cap.normal_deviation);
  }
}

TEST(SubdivisionPart, CapsKeepTheirBounds) {
  for (const int valence : {3, 5, 6, 7, 11}) {
    SCOPED_TRACE(valence);
    check_caps(FanCage(valence, false, 100u + static_cast<std::uint64_t>(valence)));
    if (valence != 6) check_caps(FanCage(valence, true, 200u + static_cast<std::uint64_t>(valence)));
  }
}

TEST(SubdivisionPart, ItsTrianglesLieOnItsFaces) {
  for (const auto& cage : {test::cube_cage(), test::icosahedron_cage()}) {
    const SubdivisionSurface surface = surface_of(cage, 8);
    LimitPartOptions options;
    options.segments_per_edge = 16;
    Model model;
    model.parts.push_back(surface.part(options));
    const Part& part = model.parts[0];
    ASSERT_TRUE(check(model).ok());
    ASSERT_EQ(part.mesh.faces.size(), cage.polygon_count() * 256 * (cage.all_triangles() ? 1 : 2));
    for (std::size_t t = 0; t < part.mesh.faces.size(); t += 37) {
      // A corner of the triangle is a corner of its face's grid.
      const auto& p = part.mesh.positions[part.mesh.triangles[3 * t]];
      const Vec3 corner = part.mesh.origin + Vec3{p[0], p[1], p[2]};
      const Face& face = part.faces[part.mesh.faces[t]];
      double least = 1e300;
      for (int i = 0; i <= 16; ++i)
        for (int j = 0; j <= 16; ++j) {
          const Vec2 uv = face.uv_box.lo + Vec2{face.uv_box.size().x * i / 16, face.uv_box.size().y * j / 16};
          least = std::min(least, distance(point_at(part.surfaces[face.surface], uv.x, uv.y), corner));
        }
      EXPECT_LT(least, 1e-6 * diagonal(cage));
    }
  }
}

}  // namespace
}  // namespace dupin
