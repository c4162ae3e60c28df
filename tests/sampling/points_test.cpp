// Differential points: the papers' formulas in closed form, and sampling of faces made by hand.
#include <gtest/gtest.h>

#include <random>

#include "../../core/parallel.h"
#include "../../sampling/point_sampler.h"
#include "../../sampling/trim_region.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

Face face_over(const Box2& box, std::uint32_t surface = 0) {
  Face face;
  face.surface = surface;
  face.uv_box = box;
  return face;
}

Model model_of(const Surface& surface, const Box2& box) {
  Model model;
  Part& part = model.parts.emplace_back();
  part.surfaces.push_back(surface);
  part.faces.push_back(face_over(box));
  model.instances.emplace_back();
  return model;
}

Model sphere_model(double radius) {
  return model_of({Sphere{{}, radius}}, {{0, -kPi / 2}, {2 * kPi, kPi / 2}});
}
Model torus_model() {
  return model_of({Torus{{}, 3, 1}}, {{0, 0}, {2 * kPi, 2 * kPi}});
}

PointScene sampled(const Model& model, const PointSamplingOptions& options) {
  auto scene = sample_points(model, options);
  EXPECT_TRUE(scene.ok()) << scene.status().message;
  return scene ? std::move(*scene) : PointScene{};
}

/// Whether a rectangle holds a point of the surface, seen along its normal, on the side that it stands for.
bool covers(const DifferentialPoint& point, const Vec3& p, const Vec3& n) {
  const Vec3 d = p - point.position;
  return std::abs(dot(d, point.u)) <= point.half_u && std::abs(dot(d, point.v)) <= point.half_v &&
         dot(n, point.n()) > 0.3 && std::abs(dot(d, point.n())) < std::max(point.half_u, point.half_v);
}

int uncovered(const Model& model, const std::vector<DifferentialPoint>& points, int trials) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  const Surface& surface = model.parts[0].surfaces[0];
  const Box2 box = model.parts[0].faces[0].uv_box;
  int holes = 0;
  for (int i = 0; i < trials; ++i) {
    const double u = box.lo.x + box.size().x * part(random), v = box.lo.y + box.size().y * part(random);
    const SurfaceJet jet = evaluate(surface, u, v, 1);
    const Vec3 n = normalized(cross(jet.pu, jet.pv)) * (model.parts[0].faces[0].reversed ? -1.0 : 1.0);
    holes += std::none_of(points.begin(), points.end(),
                          [&](const DifferentialPoint& p) { return covers(p, jet.p, n); });
  }
  return holes;
}

TEST(DifferentialPoint, ExtentsKeepTheOsculatingCirclesWithinEpsilon) {
  for (const double epsilon : {1e-6, 0.012, 0.3, 1.0})
    for (const double lambda : {0.01, -2.0, 400.0}) {
      DifferentialPoint point;
      point.lambda_u = lambda;
      point.lambda_v = 0;
      set_extents(point, epsilon, 1e9);
      EXPECT_NEAR(point.bound * std::abs(lambda), epsilon, 1e-9 * epsilon + 1e-15);
      EXPECT_EQ(point.half_v, 1e9);
      set_extents(point, epsilon, 1e-3);
      EXPECT_LE(point.half_u, 1e-3);
    }
}

TEST(DifferentialPoint, NormalFieldTurnsWithTheArcLength) {
  // Along a principal direction the field is ê_z − λ s ê_x with the arc's length s = arcsin(λx)/λ.
  for (const double lambda : {-0.7, 0.2, 0.9}) {
    const Vec3 n = local_normal_field(lambda, 0.1 * lambda, 0.8, 0);
    EXPECT_NEAR(std::atan2(n.x, n.z), -std::atan(std::asin(0.8 * lambda)), 1e-12);
    EXPECT_EQ(n.y, 0);
  }
  EXPECT_EQ(local_normal_field(0.5, -0.5, 0, 0), (Vec3{0, 0, 1}));
  // Where the normal curvature vanishes, on a saddle's diagonal, the arc is straight and the normal still
  // turns.
  const Vec3 saddle = local_normal_field(0.5, -0.5, 0.3, 0.3);
  EXPECT_NEAR(saddle.x / saddle.z, -0.15, 1e-12);
  EXPECT_NEAR(saddle.y / saddle.z, 0.15, 1e-12);
  EXPECT_TRUE(is_finite(local_normal_field(2, 1, 50, -3))) << "beyond the circle's end";
}

TEST(DifferentialPoint, NormalFieldIsThatOfLemmaOne) {
  // n_p(u,v) = n_m(λu·u, λu·v) with λ = 1 and the same ρ, up to the sign of λu, which turns with the
  // coordinates.
  for (const double lambda : {3.0, 0.01})
    for (const double rho : {-1.0, -0.3, 0.0, 0.6, 1.0}) {
      const double x = 0.2 / lambda, y = -0.15 / lambda;
      EXPECT_LT(distance(local_normal_field(lambda, rho * lambda, x, y),
                         local_normal_field(1, rho, lambda * x, lambda * y)),
                1e-12);
    }
}

TEST(DifferentialPoint, PlacedHasTheCurvaturesOfTheMappedSurface) {
  DifferentialPoint point;  // the top of a unit sphere
  point.position = {0, 0, 1};
  point.lambda_u = point.lambda_v = -1;
  set_extents(point, 0.1, 1);
  Affine3 map;
  map.linear = {{2, 0, 0}, {0, -3, 0}, {0, 0, 4}};  // an ellipsoid, mirrored
  map.translation = {5, 6, 7};
  const DifferentialPoint there = placed(point, map);
  EXPECT_NEAR(there.lambda_u, -4.0 / 4, 1e-12);
  EXPECT_NEAR(there.lambda_v, -4.0 / 9, 1e-12);
  EXPECT_NEAR(std::abs(there.u.x), 1, 1e-12);
  EXPECT_NEAR(distance(there.n(), {0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(distance(there.position, {5, 6, 11}), 0, 1e-12);
}

TEST(UniformPoints, LieOnTheParametersOfTheirPatches) {
  PointSamplingOptions options;
  options.delta = 1;
  options.grid = 9;
  const Model model = torus_model();
  const PointScene scene = sampled(model, options);
  const PartPoints& part = scene.parts[0];
  ASSERT_EQ(part.grids.size(), 16U);  // quarters
  ASSERT_EQ(part.points.size(), 16U * 81);
  for (const SampleGrid& grid : part.grids)
    for (std::uint32_t i = 0; i < grid.rows; ++i)
      for (std::uint32_t j = 0; j < grid.columns; ++j) {
        const DifferentialPoint& point = part.points[part.grid_points[grid.first + i * grid.columns + j]];
        const double turn = point.uv.x / (2 * kPi) * 32;
        EXPECT_NEAR(turn, std::round(turn), 1e-9);
        EXPECT_LT(distance(point.position, point_at(model.parts[0].surfaces[0], point.uv.x, point.uv.y)),
                  1e-14);
        const double across = std::cos(point.uv.y) / (3 + std::cos(point.uv.y));
        EXPECT_NEAR(point.lambda_u, -1, 1e-12);
        EXPECT_NEAR(point.lambda_v, -across, 1e-12);
        EXPECT_NEAR(
            dot(point.n(), point.position - Vec3{3 * std::cos(point.uv.x), 3 * std::sin(point.uv.x), 0}), 1,
            1e-12);
      }
}

TEST(UniformPoints, ReversedFacesHaveTheirNormalsAndCurvaturesTurned) {
  PointSamplingOptions options;
  options.delta = 1;
  options.grid = 4;
  Model model = sphere_model(2);
  model.parts[0].faces[0].reversed = true;
  const PointScene scene = sampled(model, options);
  for (const DifferentialPoint& point : scene.parts[0].points) {
    EXPECT_NEAR(point.lambda_u, 0.5, 1e-7);
    EXPECT_NEAR(dot(point.n(), normalized(point.position)), -1, 1e-7);
  }
}

TEST(UniformPoints, AsDenseAsTheirRectanglesReachCoverTheSurface) {
  PointSamplingOptions options;
  options.delta = 0.5;
  options.epsilon = 0.02;
  for (const Model& model : {sphere_model(2), torus_model()})
    EXPECT_EQ(uncovered(model, sampled(model, options).parts[0].points, 2000), 0);
}

TEST(UniformPoints, FollowASpacing) {
  PointSamplingOptions options;
  options.delta = 1;
  options.spacing = 0.1;
  const PartPoints part = sampled(torus_model(), options).parts[0];
  double largest = 0;
  for (const SampleGrid& grid : part.grids)
    for (std::uint32_t i = 0; i + 1 < grid.rows; ++i)
      for (std::uint32_t j = 0; j + 1 < grid.columns; ++j) {
        const auto at = [&](std::uint32_t r, std::uint32_t c) {
          return part.points[part.grid_points[grid.first + r * grid.columns + c]].position;
        };
        largest = std::max({largest, distance(at(i, j), at(i + 1, j)), distance(at(i, j), at(i, j + 1))});
      }
  EXPECT_LE(largest, 0.1 * 1.03);
  EXPECT_GT(largest, 0.09);
}

/// A square hole in a plate, and a sliver beside a sample line.
Model trimmed_plane(const std::vector<std::vector<Vec2>>& polygons) {
  Model model = model_of({Plane{}}, {});
  Part& part = model.parts[0];
  for (const auto& polygon : polygons) {
    Loop loop;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()], d = b - a;
      Trim trim;
      trim.edge = static_cast<std::uint32_t>(part.edges.size());
      trim.pcurve.geometry = LineOf<Vec2>{a, d / length(d)};
      Edge& edge = part.edges.emplace_back();
      edge.t1 = length(d);
      edge.curve = Curve3{LineOf<Vec3>{{a.x, a.y, 0}, Vec3{d.x, d.y, 0} / length(d)}};
      loop.push_back(trim);
      part.faces[0].uv_box.add(a);
    }
    part.faces[0].loops.push_back(loop);
  }
  return model;
}

TEST(UniformPoints, StayWithinTheTrims) {
  const Model model = trimmed_plane({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{3, 3}, {3, 7}, {7, 7}, {7, 3}}});
  PointSamplingOptions options;
  options.delta = 1;
  options.grid = 41;
  const PartPoints part = sampled(model, options).parts[0];
  EXPECT_EQ(part.points.size(), 41U * 41U - 17U * 17U);
  for (const DifferentialPoint& p : part.points)
    EXPECT_FALSE(p.position.x > 3 && p.position.x < 7 && p.position.y > 3 && p.position.y < 7);
}

TEST(UniformPoints, DoNotMissASliver) {
  const Model model = trimmed_plane({{{0, 0}, {10, 0.01}, {10, 10}}, {{0.2, 0.15}, {9.9, 0.2}, {9.9, 9.8}}});
  PointSamplingOptions options;
  options.delta = 1;
  options.grid = 3;
  const PartPoints part = sampled(model, options).parts[0];
  EXPECT_FALSE(part.points.empty());
  EXPECT_TRUE(part.skipped.empty());
}

TEST(UniformPoints, AFaceWithoutAPointIsListed) {
  Model model = trimmed_plane({{{0, 0}, {1, 0}, {1, 1}}});
  model.parts[0].faces[0].loops[0].resize(2);  // the loop encloses nothing
  model.parts[0].faces[0].loops[0][1] = model.parts[0].faces[0].loops[0][0];
  model.parts[0].faces[0].loops[0][1].reversed = true;
  model.parts[0].faces[0].name = "nothing";
  PointSamplingOptions options;
  options.delta = 1;
  options.grid = 3;
  const PartPoints part = sampled(model, options).parts[0];
  ASSERT_EQ(part.skipped.size(), 1U);
  EXPECT_EQ(part.skipped[0].name, "nothing");
}

TEST(AdaptivePoints, CoverTheSurfaceWithFewerPointsThanUniformOnes) {
  PointSamplingOptions options;
  options.delta = 0.8;
  options.epsilon = 0.01;
  for (const Model& model : {sphere_model(2), torus_model()}) {
    options.method = PointMethod::adaptive;
    const PointScene adaptive = sampled(model, options);
    EXPECT_EQ(uncovered(model, adaptive.parts[0].points, 2000), 0);
    for (const DifferentialPoint& p : adaptive.parts[0].points) {
      EXPECT_LE(p.half_u, half_extent(p.lambda_u, 0.01, 0.8));
      EXPECT_LE(p.half_v, half_extent(p.lambda_v, 0.01, 0.8));
    }
    options.method = PointMethod::uniform;
    EXPECT_LT(2 * adaptive.count(), sampled(model, options).count());
  }
}

TEST(AdaptivePoints, StandOutOverTrimsByTheBorderAtMost) {
  const Model model = trimmed_plane({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{3, 3}, {5, 7}, {7, 6}}});
  PointSamplingOptions options;
  options.method = PointMethod::adaptive;
  options.delta = 2;
  options.border = 0.1;
  const PartPoints part = sampled(model, options).parts[0];
  const TrimRegion region(model.parts[0], model.parts[0].faces[0]);
  for (const DifferentialPoint& p : part.points)
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0}) {
        const Vec3 corner = p.position + p.u * (s * p.half_u) + p.v * (t * p.half_v);
        const Vec2 uv{corner.x, corner.y};
        const Box2 around{uv - Vec2{0.3, 0.3}, uv + Vec2{0.3, 0.3}};
        EXPECT_TRUE(region.contains(uv) || region.overlap(around) == TrimRegion::Overlap::crossing);
      }
}

TEST(AdaptivePoints, StandOutOverTheSidesOfASurfaceByTheBorderAtMost) {
  // z = xy: the principal directions are at 45° to the sides at the middle.
  BsplineSurface saddle;
  saddle.degree_u = saddle.degree_v = 1;
  saddle.count_u = saddle.count_v = 2;
  saddle.knots_u = saddle.knots_v = {-1, -1, 1, 1};
  saddle.poles = {{-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1}};
  PointSamplingOptions options;
  options.method = PointMethod::adaptive;
  options.delta = 0.4;
  options.border = 0.02;
  const Model model = model_of({saddle}, {{-1, -1}, {1, 1}});
  const PartPoints part = sampled(model, options).parts[0];
  EXPECT_EQ(uncovered(model, part.points, 2000), 0);
  double most = 0;
  for (const DifferentialPoint& p : part.points)
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0}) {
        const Vec3 corner = p.position + p.u * (s * p.half_u) + p.v * (t * p.half_v);
        most = std::max({most, std::abs(corner.x), std::abs(corner.y)});
      }
  EXPECT_LT(most, 1.03);
  EXPECT_GT(most, 1.002);
}

TEST(Points, AreTheSameForAnyNumberOfThreads) {
  for (const PointMethod method : {PointMethod::uniform, PointMethod::adaptive}) {
    PointSamplingOptions options;
    options.method = method;
    options.delta = 0.3;
    set_thread_limit(1);
    const PointScene one = sampled(torus_model(), options);
    set_thread_limit(0);
    const PointScene many = sampled(torus_model(), options);
    ASSERT_EQ(one.count(), many.count());
    for (std::size_t i = 0; i < one.count(); ++i)
      EXPECT_EQ(one.parts[0].points[i].position, many.parts[0].points[i].position);
  }
}

TEST(Points, OptionsOutOfRangeAreRefused) {
  const auto code = [](double epsilon, double delta, int grid) {
    PointSamplingOptions options;
    options.epsilon = epsilon;
    options.delta = delta;
    options.grid = grid;
    return sample_points(sphere_model(1), options).status().code;
  };
  EXPECT_EQ(code(0, 1, 4), StatusCode::invalid_argument);
  EXPECT_EQ(code(1.5, 1, 4), StatusCode::invalid_argument);
  EXPECT_EQ(code(0.1, 0, 4), StatusCode::invalid_argument);
  EXPECT_EQ(code(0.1, 1, 1), StatusCode::invalid_argument);
  EXPECT_EQ(code(0.1, 1, 100000), StatusCode::limit);
}

TEST(CertifiedPoints, CarryTheirQuadricsFrameCurvaturesAndBound) {
  PointSamplingOptions options;
  options.method = PointMethod::certified;
  options.tolerance = 0.01;
  const PointScene scene = sampled(torus_model(), options);
  EXPECT_GT(scene.count(), 20U);
  for (const DifferentialPoint& p : scene.parts[0].points) {
    EXPECT_GE(std::abs(p.lambda_u), std::abs(p.lambda_v));
    EXPECT_LE(p.bound, 0.01);
    const Vec3 axis = normalized(Vec3{p.position.x, p.position.y, 0}) * 3;
    EXPECT_NEAR(dot(p.n(), normalized(p.position - axis)), 1, 1e-6);
    EXPECT_NEAR(p.lambda_u, -1, 1e-6);
  }
}

}  // namespace
}  // namespace dupin
