// Differential points and splats as pictures: no holes, and depths, normals and curvatures as near the
// surface as they can be.
#include <cmath>

#include "../../render/normal_maps.h"
#include "../../render/view.h"
#include "../../sampling/ball_radius.h"
#include "../../sampling/point_sampler.h"
#include "../../simplify/dp_codec.h"
#include "../../simplify/prune.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 2, kEpsilon = 0.004;

/// A sphere about the origin, of points as dense as their rectangles reach.
struct SphereOfPoints {
  Model model;
  PointScene points;
  explicit SphereOfPoints(PointMethod method = PointMethod::uniform, double spacing = 0) {
    Part& part = model.parts.emplace_back();
    part.surfaces.push_back({Sphere{{}, kRadius}});
    Face face;
    face.uv_box = {{0, -kPi / 2}, {2 * kPi, kPi / 2}};
    part.faces.push_back(face);
    part.box.add(Vec3{-kRadius, -kRadius, -kRadius});
    part.box.add(Vec3{kRadius, kRadius, kRadius});
    part.closed = true;
    model.instances.emplace_back();
    PointSamplingOptions options;
    options.method = method;
    options.epsilon = kEpsilon;
    options.delta = 1;
    options.spacing = spacing;
    points = *sample_points(model, options);
  }
};

struct Shown {
  TestDevice gl;
  std::unique_ptr<Scene> scene;
  Shown(const Model& model, const PointContent& content) {
    auto made = gl.renderer->upload(model, {nullptr, {}, content});
    EXPECT_TRUE(made.ok()) << made.status().message;
    scene = std::move(*made);
  }
  Frame draw(const Camera& camera, DrawOptions options = {}) {
    options.outputs |= kEverything;
    return gl.draw(*scene, camera, options);
  }
};

Camera looking(const Vec3& from, bool orthographic = false) {
  Camera camera;
  camera.eye = from;
  camera.target = {};
  camera.up = {0.1, 0.2, 1};
  camera.orthographic = orthographic;
  camera.ortho_height = 5;
  camera.fov_degrees = 30;
  camera.width = 240;
  camera.height = 200;
  return camera;
}

/// How a drawn sphere differs from the real one, over pixels that see it well inside its outline.
struct SphereErrors {
  int inside = 0, holes = 0;
  double depth = 0, normal_degrees = 0, mean_degrees = 0;
};
SphereErrors errors(const Frame& frame, const Camera& camera) {
  SphereErrors e;
  const CameraAxes axes = camera_axes(camera);
  const double half =
      camera.orthographic ? camera.ortho_height / 2 : std::tan(camera.fov_degrees * kPi / 360);
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      const double x = ((column + 0.5) * 2 / camera.width - 1) * half * camera.width / camera.height,
                   y = (1 - (row + 0.5) * 2 / camera.height) * half;
      const Vec3 across = axes.right * x + axes.up * y;
      const Vec3 origin = camera.orthographic ? camera.eye + across : camera.eye;
      const Vec3 direction = camera.orthographic ? -axes.back : across - axes.back;
      const double a = dot(direction, direction), b = dot(origin, direction),
                   c = dot(origin, origin) - kRadius * kRadius;
      const double t = (-b - std::sqrt(std::max(0.0, b * b - a * c))) / a;
      const Vec3 p = origin + direction * t;
      if (b * b < a * c || -dot(p, direction) / (length(p) * length(direction)) < 0.35) continue;
      const auto i = static_cast<std::size_t>(row * camera.width + column);
      ++e.inside;
      if (frame.primitive[i] == 0 || std::abs(frame.depth[i] - t) > 0.5 * kRadius) {
        ++e.holes;  // or the far side seen through one
        continue;
      }
      const Vec3 n{frame.normal[3 * i], frame.normal[3 * i + 1], frame.normal[3 * i + 2]};
      const double angle = std::acos(std::min(1.0, dot(n, normalized(p)))) * 180 / kPi;
      e.depth = std::max(e.depth, std::abs(frame.depth[i] - t));
      e.normal_degrees = std::max(e.normal_degrees, angle);
      e.mean_degrees += angle;
    }
  e.mean_degrees /= std::max(e.inside, 1);
  return e;
}

class BothProjections : public ::testing::TestWithParam<bool> {};

TEST_P(BothProjections, DifferentialPointsShowTheSurfaceWithoutAHole) {
  const SphereOfPoints sphere;
  for (const bool published : {true, false}) {
    Shown shown(sphere.model, {&sphere.points, PointPrimitive::differential_point, published});
    for (const Vec3& eye : {Vec3{9, -4, 5}, Vec3{0, 0.1, -11}}) {
      const Camera camera = looking(eye, GetParam());
      const SphereErrors e = errors(shown.draw(camera), camera);
      EXPECT_GT(e.inside, 5000);
      EXPECT_EQ(e.holes, 0);
      // A rectangle's corner is twice as far off as its sides, and farther as seen at a slant.
      EXPECT_LT(e.depth, 2 * kEpsilon * kRadius / 0.35);
      EXPECT_LT(e.normal_degrees, 1.2) << (published ? "published" : "analytic");
      EXPECT_LT(e.mean_degrees, 0.35);
    }
  }
}

TEST_P(BothProjections, AdaptiveAndSimplifiedPointsDoSoToo) {
  SphereOfPoints adaptive(PointMethod::adaptive), simplified;
  ASSERT_TRUE(prune(simplified.points, {}).ok());
  EXPECT_LT(adaptive.points.count() * 2, SphereOfPoints().points.count());
  for (const SphereOfPoints* sphere : {&adaptive, &simplified}) {
    Shown shown(sphere->model, {&sphere->points});
    for (const Vec3& eye : {Vec3{7, 6, 5}, Vec3{-9, 1, 3}, Vec3{0, 5, -8}}) {
      Camera camera = looking(eye, GetParam());
      camera.width = camera.height = 600;
      const SphereErrors e = errors(shown.draw(camera), camera);
      EXPECT_EQ(e.holes, 0) << sphere->points.count() << " points";
      EXPECT_LT(e.normal_degrees, 1.5);
    }
  }
}

TEST_P(BothProjections, SplatsLeaveNoHole) {
  const SphereOfPoints sphere(PointMethod::uniform, 0.08);
  for (const PointPrimitive primitive :
       {PointPrimitive::square, PointPrimitive::rectangle, PointPrimitive::ellipse}) {
    Shown shown(sphere.model, {&sphere.points, primitive});
    const Camera camera = looking({9, -4, 5}, GetParam());
    const Frame frame = shown.draw(camera);
    const SphereErrors e = errors(frame, camera);
    EXPECT_EQ(e.holes, 0) << static_cast<int>(primitive);
    // Flat shading: as far off as a ball reaches, and the splat in front of the right one may be another
    // ball's.
    EXPECT_LT(e.mean_degrees, 3.5);
    EXPECT_LT(e.depth, 0.5);
    EXPECT_EQ(shown.scene->info().bytes, 32 * sphere.points.count());
  }
}

INSTANTIATE_TEST_SUITE_P(Points, BothProjections, ::testing::Values(false, true),
                         [](const auto& info) { return info.param ? "parallel" : "perspective"; });

TEST(Points, MapsAndEquationAgree) {
  const SphereOfPoints sphere;
  Shown maps(sphere.model, {&sphere.points, PointPrimitive::differential_point, true});
  Shown equation(sphere.model, {&sphere.points, PointPrimitive::differential_point, false});
  const Camera camera = looking({9, -4, 5});
  maps.gl.context->make_current();
  const Frame a = maps.draw(camera);
  equation.gl.context->make_current();
  const Frame b = equation.draw(camera);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.primitive, b.primitive);
  double largest = 0;
  for (std::size_t i = 0; i < a.normal.size(); ++i)
    largest = std::max<double>(largest, std::abs(a.normal[i] - b.normal[i]));
  EXPECT_LT(largest, 2e-3);
}

TEST(Points, MapsHoldTheNormalFieldOfTheirRatio) {
  for (const int map : {1, 40, 127, 128, 129, 200, 255}) {
    const double rho = rho_of(static_cast<std::uint8_t>(map));
    const std::vector<float> texels = normal_map(map, 0);
    ASSERT_EQ(texels.size(), 2U * kNormalMapSize * kNormalMapSize);
    for (const int i : {0, 7, 31})
      for (const int j : {0, 15, 31}) {
        const Vec3 n = local_normal_field(1, rho, 2.0 * i / 31 - 1, map_reach(map) * (2.0 * j / 31 - 1));
        const std::size_t at = 2 * static_cast<std::size_t>(j * kNormalMapSize + i);
        EXPECT_NEAR(texels[at], n.x / n.z, 1e-6);
        EXPECT_NEAR(texels[at + 1], n.y / n.z, 1e-6);
      }
    EXPECT_EQ(normal_map(map, 5).size(), 2U);
    EXPECT_NEAR(normal_map(map, 5)[0], 0, 1e-5) << "the mean of an odd function";
  }
}

TEST(Points, EllipseTexturesAreAsSlimAsTheySay) {
  for (const int slimness : {255, 128, 40}) {
    const auto texture = ellipse_texture(slimness);
    const auto inside = std::count(texture.begin(), texture.end(), 0);
    EXPECT_NEAR(inside / double(texture.size()), kPi / 4 * slimness / 255, 0.02);
  }
}

TEST(Points, CurvaturesAreThoseOfThePlacedPoints) {
  SphereOfPoints sphere;
  Affine3 stretched;
  stretched.linear = {{1, 0, 0}, {0, -1.5, 0}, {0, 0.2, 0.8}};
  sphere.model.instances[0].to_world = stretched;
  Shown shown(sphere.model, {&sphere.points});
  const Frame frame = shown.draw(looking({9, -4, 5}));
  int checked = 0;
  for (std::size_t i = 0; i < frame.primitive.size(); i += 37) {
    if (frame.primitive[i] == 0) continue;
    const DifferentialPoint p = placed(sphere.points.parts[0].points[frame.primitive[i] - 1], stretched);
    EXPECT_NEAR(frame.curvature[2 * i], p.lambda_u, 1e-4);
    EXPECT_NEAR(frame.curvature[2 * i + 1], p.lambda_v, 1e-4);
    const Vec3 d{frame.direction[3 * i], frame.direction[3 * i + 1], frame.direction[3 * i + 2]};
    if (std::abs(p.lambda_u - p.lambda_v) > 0.01) {
      EXPECT_GT(std::abs(dot(d, p.u)), 0.999);
    }
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(Points, ShareAPictureWithQuadricsAndCountLikeThem) {
  // The sphere half sunk into a plate of quadric DPs.
  SphereOfPoints sphere(PointMethod::adaptive);
  HandMade made;
  made.add(plane_rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8));
  sphere.model.parts.push_back(made.model.parts[0]);
  sphere.model.instances.push_back({1, {}, std::nullopt, ""});
  sphere.points.parts.emplace_back();
  DpScene dps;
  dps.parts.resize(2);
  dps.parts[1] = made.pieces();
  TestDevice gl;
  auto scene = gl.renderer->upload(sphere.model, {&dps, {}, {&sphere.points}});
  ASSERT_TRUE(scene.ok()) << scene.status().message;
  EXPECT_EQ((*scene)->info().primitives, sphere.points.count() + 1);
  EXPECT_EQ((*scene)->info().drawn_faces, 2U);
  Camera camera = looking({0, 0, 12});
  camera.up = {0, 1, 0};
  DrawOptions options;
  options.outputs = kEverything;
  const Frame frame = gl.draw(**scene, camera, options);
  const std::size_t middle = 100 * 240 + 120, beside = 100 * 240 + 230;
  EXPECT_EQ(frame.face[middle], 1U);
  EXPECT_NEAR(frame.depth[middle], 10, 0.02);
  EXPECT_EQ(frame.face[beside], 2U);
  EXPECT_EQ(frame.primitive[beside], sphere.points.count() + 1);
  camera.eye.z = -12;
  const Frame below = gl.draw(**scene, camera, options);
  EXPECT_EQ(below.face[middle], 1U) << "the sphere's other half";
}

TEST(Points, PointsOfAnotherModelAreRefused) {
  const SphereOfPoints sphere;
  Model model = sphere.model;
  model.parts.emplace_back();
  TestDevice gl;
  EXPECT_EQ(gl.renderer->upload(model, {nullptr, {}, {&sphere.points}}).status().code,
            StatusCode::invalid_argument);
}

/// The brightest pixel of a frame, as a picture point.
Vec2 brightest(const Frame& frame) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < frame.primitive.size(); ++i)
    if (frame.primitive[i] && frame.color[4 * i] > frame.color[4 * best] * (frame.primitive[best] ? 1 : 0))
      best = i;
  return {static_cast<double>(best % 240), static_cast<double>(best / 240)};
}

TEST(Points, HighlightsLieWhereTheLightIsMirrored) {
  const SphereOfPoints sphere(PointMethod::adaptive);
  const Camera camera = looking({10, 0, 0});
  DrawOptions options;
  options.background = Color{0, 0, 0, 1};
  options.lights.push_back({{10, 6, 4}});
  // Between the directions to the eye and to the light, on the sphere: about 0.5 of both.
  const Vec3 toward = normalized(normalized(Vec3{10, 0, 0}) + normalized(Vec3{10, 6, 4})) * kRadius;
  const CameraAxes axes = camera_axes(camera);
  const double depth = 10 - toward.x, half = std::tan(15 * kPi / 180);
  const double x = 120 + dot(toward, axes.right) / depth / half * 100,
               y = 100 - dot(toward, axes.up) / depth / half * 100;
  for (const bool published : {true, false}) {
    Shown shown(sphere.model, {&sphere.points, PointPrimitive::differential_point, published});
    const Vec2 at = brightest(shown.draw(camera, options));
    EXPECT_NEAR(at.x, x, 5) << published;
    EXPECT_NEAR(at.y, y, 5) << published;
  }
}

TEST(Points, LightsOfBothKindsOfPointAreNearlyTheSame) {
  const SphereOfPoints sphere;
  DrawOptions options;
  options.lights = {{{10, 6, 4}, {1, 0.5F, 0.2F, 1}}, {{3, -5, 1}, {0.1F, 0.2F, 0.9F, 1}}};
  const Camera camera = looking({10, -1, 2});
  std::vector<Frame> frames;
  for (const bool published : {true, false}) {
    Shown shown(sphere.model, {&sphere.points, PointPrimitive::differential_point, published});
    frames.push_back(shown.draw(camera, options));
  }
  double largest = 0, brightest_blue = 0;
  for (std::size_t i = 0; i < frames[0].color.size(); ++i) {
    largest = std::max<double>(largest, std::abs(frames[0].color[i] - frames[1].color[i]));
    if (i % 4 == 2 && frames[0].primitive[i / 4])
      brightest_blue = std::max<double>(brightest_blue, frames[0].color[i]);
  }
  EXPECT_LT(largest, 0.02);
  EXPECT_GT(brightest_blue, 0.2) << "the second light shows too";
}

TEST(Points, TooManyLightsAreRefused) {
  const SphereOfPoints sphere(PointMethod::adaptive);
  Shown shown(sphere.model, {&sphere.points});
  DrawOptions options;
  options.lights.resize(kMostLights + 1);
  EXPECT_EQ(shown.gl.renderer->draw(*shown.scene, looking({9, 0, 0}), options).status().code,
            StatusCode::invalid_argument);
}

TEST(BallRadius, OfTheOnlySampleOfAPatchIsNoLargerThanOthers) {
  PartPoints part;
  for (int i = 0; i < 5; ++i) {
    DifferentialPoint p;
    p.position = {0.1 * i, 0, 0};
    p.half_u = p.half_v = 2;
    part.points.push_back(p);
  }
  part.grids = {{0, 1, 4}, {4, 1, 2}};
  part.grid_points = {0, 1, 2, 3, kNoPoint, 4};
  for (const float radius : ball_radii(part)) EXPECT_FLOAT_EQ(radius, 0.1F);
  part.pruned = true;
  for (const float radius : ball_radii(part)) EXPECT_FLOAT_EQ(radius, 4 * std::sqrt(2.0F));
}

TEST(BallRadius, ReachesTheFarthestSampleAround) {
  const SphereOfPoints sphere(PointMethod::uniform, 0.1);
  const PartPoints& part = sphere.points.parts[0];
  const std::vector<float> radii = ball_radii(part);
  const SampleGrid& grid = part.grids[3];
  for (std::uint32_t i = 1; i + 1 < grid.rows; ++i)
    for (std::uint32_t j = 1; j + 1 < grid.columns; ++j) {
      const auto at = [&](std::uint32_t r, std::uint32_t c) {
        return part.grid_points[grid.first + r * grid.columns + c];
      };
      double farthest = 0;
      for (const int di : {-1, 0, 1})
        for (const int dj : {-1, 0, 1})
          farthest = std::max(
              farthest,
              distance(part.points[at(i, j)].position,
                       part.points[at(i + static_cast<std::uint32_t>(di), j + static_cast<std::uint32_t>(dj))]
                           .position));
      EXPECT_FLOAT_EQ(radii[at(i, j)], static_cast<float>(farthest));
    }
}

}  // namespace
}  // namespace dupin::testing
