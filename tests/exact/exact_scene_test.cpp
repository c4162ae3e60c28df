// Whole models by the exact ray caster: closed forms, placements, cracks, and the shipped samples.
#include "../../exact/exact_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../../cad_import/cad_import.h"
#include "../nurbs/random_geometry.h"
#include "one_face.h"

namespace dupin::exact {
namespace {

using testing::Random;
constexpr double kPi = std::numbers::pi;

Model sphere_model(double radius) {
  Model model = testing::empty_model();
  testing::add_face(model, {Sphere{{}, radius}}, {{0, -kPi / 2}, {2 * kPi, kPi / 2}});
  return model;
}

TEST(ExactScene, ASphereIsItsClosedForm) {
  const Model model = sphere_model(2);
  const ExactScene scene(model);
  Camera camera;
  camera.eye = {5, -7, 4};
  camera.width = camera.height = 200;
  int covered = 0;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      const Line ray = pixel_ray(camera, column, row);
      const double dd = dot(ray.direction, ray.direction), b = dot(ray.origin, ray.direction),
                   disc = b * b - dd * (dot(ray.origin, ray.origin) - 4);
      const auto hit = scene.cast(ray, 0);
      ASSERT_EQ(hit.has_value(), disc > 0) << column << " " << row;
      if (!hit) continue;
      ++covered;
      EXPECT_NEAR(hit->depth, (-b - std::sqrt(disc)) / dd, 1e-12);
      EXPECT_LT(distance(hit->normal, hit->point / 2.0), 1e-12);
      EXPECT_NEAR(hit->k1, -0.5, 1e-12);  // bends away from the outward normal
      EXPECT_NEAR(hit->k2, -0.5, 1e-12);
    }
  EXPECT_GT(covered, 10000);
}

TEST(ExactScene, PixelRaysAreThoseOfTheCamera) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.target = {4, 0, 1};
  camera.width = 300;
  camera.height = 200;
  const CameraAxes axes = camera_axes(camera);
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    camera.ortho_height = 6;
    const Line first = pixel_ray(camera, 0, 0), next = pixel_ray(camera, 1, 0),
               below = pixel_ray(camera, 0, 1);
    EXPECT_NEAR(dot(first.direction, -axes.back), 1, 1e-14);
    const auto at = [](const Line& l) { return l.origin + l.direction * 7.0; };
    EXPECT_NEAR(dot(at(next) - at(first), axes.right), pixel_size(camera, 7), 1e-12);
    EXPECT_NEAR(dot(at(first) - at(below), axes.up), pixel_size(camera, 7), 1e-12);
    const Line a = pixel_ray(camera, 149, 99), b = pixel_ray(camera, 150, 100);
    EXPECT_LT(distance(0.5 * (at(a) + at(b)), camera.eye - axes.back * 7.0), 1e-12);
  }
}

TEST(ExactScene, PlacementsTurnMirrorAndScale) {
  Model model = sphere_model(1);
  Random random(5);
  const Vec3 axis = random.direction();
  const Vec3 x = any_perpendicular(axis), y = cross(axis, x);
  model.instances[0].to_world = {{x * 3.0, y * 3.0, axis * -3.0},
                                 {10, 0, 0}};  // mirrored, three times as large
  ASSERT_LT(determinant(model.instances[0].to_world.linear), 0);
  const ExactScene scene(model);
  const auto hit = scene.cast({{10, -20, 0.5}, {0, 1, 0}}, 0);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->depth, 20 - std::sqrt(9 - 0.25), 1e-12);
  EXPECT_LT(distance(hit->normal, (hit->point - Vec3{10, 0, 0}) / 3.0), 1e-12);
  EXPECT_NEAR(hit->k1, -1.0 / 3, 1e-12);
  EXPECT_EQ(hit->number, 1U);
}

TEST(ExactScene, ReversedFacesTurnNormalsAndCurvatures) {
  Model model = sphere_model(1);
  model.parts[0].faces[0].reversed = true;
  const auto hit = ExactScene(model).cast({{0, 0.1, 5}, {0, 0, -1}}, 0);
  ASSERT_TRUE(hit);
  EXPECT_LT(distance(hit->normal, -hit->point), 1e-12);
  EXPECT_NEAR(hit->k1, 1, 1e-12);
}

TEST(ExactScene, PolesAndSeamsAreCovered) {
  const Model model = sphere_model(1);
  const ExactScene scene(model);
  for (const double x : {0.0, 1e-300, 1e-17, 1e-9, -1e-12}) {
    const auto pole = scene.cast({{x, 0, 5}, {0, 0, -1}}, 0);
    ASSERT_TRUE(pole) << x;
    EXPECT_NEAR(pole->depth, 4, 1e-12);
    EXPECT_NEAR(pole->normal.z, 1, 1e-8);
    EXPECT_TRUE(scene.cast({{5, x, 0.3}, {-1, 0, 0}}, 0)) << x;
  }
}

/// Two squares in z = 0 that share the edge x = 0, from which their own borders stay half a gap away.
Model two_squares(double gap) {
  Model model = testing::empty_model();
  const std::vector<ParameterRange> ranges(4, {0, 1});
  const auto square = [&](double x0, double x1) {
    testing::add_face(model, {Plane{}}, {{std::min(x0, x1), 0}, {std::max(x0, x1), 1}});
    const Vec2 c[4] = {{x0, 0}, {x0, 1}, {x1, 1}, {x1, 0}};
    std::vector<Curve2> sides;
    for (int i = 0; i < 4; ++i) sides.push_back({LineOf<Vec2>{c[i], c[(i + 1) % 4] - c[i]}});
    testing::add_loop(model, model.parts[0].faces.size() - 1, sides, ranges);
  };
  square(-gap / 2, -1);
  square(gap / 2, 1);
  Part& part = model.parts[0];
  part.edges[0].curve = Curve3{LineOf<Vec3>{{0, 0, 0}, {0, 1, 0}}};
  part.edges[0].tolerance = gap;
  part.faces[1].loops[0][0].edge = 0;
  return model;
}

TEST(ExactScene, ACrackBetweenFacesThatShareAnEdgeIsClosed) {
  const Line through{{1e-5, 0.5, 3}, {0, 0, -1}};
  Model model = two_squares(1e-4);
  const auto hit = ExactScene(model).cast(through, 0);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->in_crack);
  EXPECT_NEAR(hit->depth, 3, 1e-12);
  EXPECT_EQ(hit->number, 1U);
  const auto beside = ExactScene(model).cast({{0.2, 0.5, 3}, {0, 0, -1}}, 0);
  ASSERT_TRUE(beside);
  EXPECT_FALSE(beside->in_crack);
  EXPECT_FALSE(ExactScene(model).cast({{0.5, 1 + 1e-6, 3}, {0, 0, -1}}, 0)) << "a free edge is where it is";
  model.parts[0].edges[0].curve.reset();
  model.parts[0].faces[1].loops[0][0].edge = 4;  // no edge in common, and none that either is off from: a gap
  EXPECT_FALSE(ExactScene(model).cast(through, 0));
}

TEST(ExactScene, OfCoincidentFacesTheFirstIsSeen) {
  Model model = testing::empty_model();
  for (int i = 0; i < 2; ++i) testing::add_face(model, {Plane{}}, {{-1, -1}, {1, 1}});
  const auto hit = ExactScene(model).cast({{0.1, 0.2, 3}, {0, 0, -1}}, 0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->number, 1U);
}

TEST(ExactScene, ClosedSamplesHaveNoHoles) {
  // Every line through a closed solid enters as often as it leaves; from outside the first face met is an
  // outer side.
  ImportOptions options;
  options.reader = DUPIN_TEST_READER;
  const Result<Model> model = import_cad(DUPIN_SAMPLES "/bracket.step", options);
  ASSERT_TRUE(model.ok()) << model.status().message;
  const ExactScene scene(*model);
  EXPECT_TRUE(scene.incomplete_faces().empty());
  const Box3 box = bounding_box(*model);
  Random random(1);
  int met = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 target = box.center() + Vec3{random.between(-0.5, 0.5) * box.size().x,
                                            random.between(-0.5, 0.5) * box.size().y,
                                            random.between(-0.5, 0.5) * box.size().z};
    const Vec3 direction = random.direction();
    const Line line{target - direction * (2 * box.diagonal()), direction};
    const auto hit = scene.cast(line, 0);
    if (!hit) continue;
    ++met;
    EXPECT_LT(dot(hit->normal, direction), 1e-6) << "seen from inside: trial " << trial;
  }
  EXPECT_GT(met, 5000);
}

}  // namespace
}  // namespace dupin::exact
