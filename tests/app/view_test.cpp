// Cameras from options, and what fitting promises.
#include "../../app/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../render/view.h"

namespace dupin::app {
namespace {

Model box_model(const Vec3& lo, const Vec3& hi) {
  Model model;
  Part part;
  part.box.add(lo);
  part.box.add(hi);
  // bounding_box goes through parts that have faces.
  part.surfaces.push_back({Plane{}});
  part.faces.push_back({});
  model.parts.push_back(part);
  model.instances.push_back({});
  return model;
}

/// The largest |x| and |y| of the box's corners in the picture, where 1 is the border.
Vec2 extent_in_picture(const Camera& camera, const Box3& box) {
  const CameraAxes axes = camera_axes(camera);
  const double tangent = std::tan(camera.fov_degrees * 3.14159265358979323846 / 360);
  Vec2 largest{0, 0};
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = box.corner(i) - camera.eye;
    const double half = camera.orthographic ? camera.ortho_height / 2 : -dot(d, axes.back) * tangent;
    EXPECT_GT(-dot(d, axes.back), 0) << "behind the eye";
    largest.x = std::max(largest.x, std::abs(dot(d, axes.right)) / (half * camera.width / camera.height));
    largest.y = std::max(largest.y, std::abs(dot(d, axes.up)) / half);
  }
  return largest;
}

class StandardViews : public testing::TestWithParam<const char*> {};

TEST_P(StandardViews, ShowTheWholeModelAsLargeAsTheyMay) {
  for (const Vec3& size : {Vec3{1, 2, 3}, Vec3{1e-3, 1e-3, 1e-3}, Vec3{1000, 1, 1}, Vec3{0, 5, 5}})
    for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{1e7, -1e7, 1e7}})
      for (bool orthographic : {false, true})
        for (int width : {300, 1000}) {
          const Model model = box_model(at, at + size);
          ViewOptions options;
          options.view = GetParam();
          options.orthographic = orthographic;
          options.resolution = {width, 500};
          const Result<Camera> camera = make_camera(options, model);
          ASSERT_TRUE(camera.ok());
          const Vec2 extent = extent_in_picture(*camera, bounding_box(model));
          // A box 10,000 km from zero has coordinates that are rounded to nanometres.
          EXPECT_NEAR(std::max(extent.x, extent.y), 1 - kFitMargin, 1e-4)
              << size.x << " " << at.x << " " << orthographic;
        }
}
INSTANTIATE_TEST_SUITE_P(View, StandardViews,
                         testing::Values("iso", "front", "back", "left", "right", "top", "bottom"));

TEST(View, FrontIsSeenAlongYWithZUp) {
  ViewOptions options;
  options.view = "front";
  const Result<Camera> camera = make_camera(options, box_model({0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(camera.ok());
  const CameraAxes axes = camera_axes(*camera);
  EXPECT_NEAR(distance(axes.back, {0, -1, 0}), 0, 1e-12);
  EXPECT_NEAR(distance(axes.right, {1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(distance(axes.up, {0, 0, 1}), 0, 1e-12);
}

TEST(View, ExplicitCamerasAreTakenAsTheyAre) {
  ViewOptions options;
  options.eye = {10, 20, 30};
  options.target = {1, 2, 3};
  options.up = {0, 1, 0};
  options.fov_degrees = 45;
  const Result<Camera> camera = make_camera(options, box_model({0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(camera.ok());
  EXPECT_EQ(camera->eye, (Vec3{10, 20, 30}));
  EXPECT_EQ(camera->target, (Vec3{1, 2, 3}));
  EXPECT_EQ(camera->up, (Vec3{0, 1, 0}));
  EXPECT_EQ(camera->fov_degrees, 45);
}

TEST(View, AParallelPictureHasTheHeightAskedFor) {
  ViewOptions options;
  options.orthographic = true;
  options.height = 7.5;
  const Result<Camera> camera = make_camera(options, box_model({0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(camera.ok());
  EXPECT_TRUE(camera->orthographic);
  EXPECT_EQ(camera->ortho_height, 7.5);
}

TEST(View, ATargetWithoutAnEyeIsSeenFromTheSameSideAndAsFarOff) {
  const Model model = box_model({0, 0, 0}, {1, 2, 3});
  ViewOptions options;
  const Result<Camera> fitted = make_camera(options, model);
  options.target = {5, 6, 7};
  const Result<Camera> moved = make_camera(options, model);
  ASSERT_TRUE(fitted.ok() && moved.ok());
  EXPECT_EQ(moved->target, (Vec3{5, 6, 7}));
  EXPECT_LT(distance(moved->eye - moved->target, fitted->eye - fitted->target), 1e-12);
}

TEST(View, AnEyeWithoutATargetLooksAtTheMiddle) {
  ViewOptions options;
  options.eye = {10, 10, 10};
  options.view = "top";
  const Result<Camera> camera = make_camera(options, box_model({0, 0, 0}, {1, 2, 3}));
  ASSERT_TRUE(camera.ok());
  EXPECT_EQ(camera->target, (Vec3{0.5, 1, 1.5}));
  EXPECT_EQ(camera->up, (Vec3{0, 0, 1}));
}

TEST(View, AnEmptyModelHasACamera) {
  const Result<Camera> camera = make_camera({}, {});
  ASSERT_TRUE(camera.ok());
  EXPECT_TRUE(is_finite(camera->eye));
}

}  // namespace
}  // namespace dupin::app
