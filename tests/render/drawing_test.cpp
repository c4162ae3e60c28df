// Drawn pictures against a ray caster in double: coverage, depth, normals, curvatures, numbers.
#include "../../render/image.h"
#include "../../render/view.h"
#include "device.h"
#include "oracle.h"

namespace dupin::testing {
namespace {

/// What float arithmetic may cost in a picture at which a few hundred pixels see the scene.
constexpr double kDepthPx = 0.02, kNormalDegrees = 0.03, kCurvature = 1e-3;
/// Pixels whose centre a silhouette or an edge passes within rounding, per pixel covered.
constexpr double kBoundaryShare = 1e-4;

void expect_same(const Differences& d) {
  EXPECT_GT(d.covered, d.pixels / 50);
  EXPECT_LE(d.coverage, 1 + kBoundaryShare * d.covered);
  EXPECT_LE(d.other_primitive, 2 + kBoundaryShare * d.covered);
  EXPECT_LE(d.depth_px, kDepthPx);
  EXPECT_LE(d.normal_degrees, kNormalDegrees);
  EXPECT_LE(d.curvature, kCurvature);
}

Differences draw_and_compare(const HandMade& made, const Camera& camera, Device device = Device::automatic) {
  TestDevice gl(device);
  const auto scene = gl.upload(made);
  DrawOptions options;
  options.outputs = kEverything;
  return differences(made, camera, gl.draw(*scene, camera, options));
}

Camera small_camera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  return camera;
}

Camera fitted(const HandMade& made, std::string_view name, const Camera& settings) {
  Box3 box;
  for (const Instance& instance : made.model.instances)
    box.add(transform_box(instance.to_world, made.model.parts[0].box));
  return *fit_view(box, name, settings);
}

class EveryView : public ::testing::TestWithParam<std::string_view> {};

TEST_P(EveryView, PerspectiveMatchesTheRayCaster) {
  HandMade made = every_kind();
  made.place({});
  expect_same(draw_and_compare(made, fitted(made, GetParam(), small_camera())));
}

TEST_P(EveryView, ParallelMatchesTheRayCaster) {
  HandMade made = every_kind();
  made.place({});
  Camera camera = small_camera();
  camera.orthographic = true;
  expect_same(draw_and_compare(made, fitted(made, GetParam(), camera)));
}

INSTANTIATE_TEST_SUITE_P(Drawing, EveryView, ::testing::ValuesIn(kViewNames),
                         [](const auto& info) { return std::string(info.param); });

TEST(Drawing, OsMesaMatchesTheRayCaster) {
  HandMade made = every_kind();
  made.place({});
  expect_same(draw_and_compare(made, fitted(made, "iso", small_camera()), Device::osmesa));
}

TEST(Drawing, PlacementsMayTurnMirrorAndStretch) {
  HandMade made = every_kind();
  made.place(rigid({1, 2, 3}, 0.7, {4, 0, 0}));
  Affine3 mirrored;
  mirrored.linear = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  made.place(mirrored);
  Affine3 stretched = rigid({0, 1, 1}, -1.1, {0, 4, 0});
  stretched.linear = stretched.linear * Mat3{{1.5, 0, 0}, {0, 0.6, 0}, {0, 0, 1}};
  made.place(stretched);
  Affine3 both = rigid({1, 0, 1}, 2.1, {4, 4, 1});
  both.linear = both.linear * Mat3{{0.5, 0, 0}, {0, -1.3, 0}, {0, 0.2, 1}};
  made.place(both);
  Camera camera = small_camera();
  camera.width = 480;
  camera.height = 480;
  // The caster's curvatures are those of the unstretched quadrics: the stretched ones are another test's.
  Differences d = draw_and_compare(made, fitted(made, "iso", camera));
  d.curvature = 0;
  expect_same(d);
}

TEST(Drawing, TheEyeMayBeInsideAPrimitivesBox) {
  HandMade made = every_kind();
  made.place({});
  Camera camera = small_camera();
  camera.fov_degrees = 70;
  camera.eye = {-0.5, 0.5, 0.85};  // inside the cylinder
  camera.target = {1, 1.1, 1.0};
  expect_same(draw_and_compare(made, camera));
  camera.eye = {0.55, -0.55, 0.55};  // inside the sphere
  camera.target = {0, 0, 0.2};
  expect_same(draw_and_compare(made, camera));
}

TEST(Drawing, EveryFrameShowsItsOwnCamera) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  DrawOptions options;
  options.outputs = kEverything;
  for (const std::string_view view : {"iso", "bottom", "left"}) {
    const Camera camera = fitted(made, view, small_camera());
    expect_same(differences(made, camera, gl.draw(*scene, camera, options)));
  }
}

TEST(Drawing, ScreenColorsAreTheEncodedLinearOnes) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  const Camera camera = fitted(made, "iso", small_camera());
  for (const int samples : {1, 4, 20})
    for (const bool opaque : {true, false}) {
      DrawOptions options;
      options.samples = samples;
      if (!opaque) options.background.reset();
      options.outputs = kScreen;
      const Image8 screen = screen_image(gl.draw(*scene, camera, options));
      options.outputs = kColor;
      const Image8 encoded = to_image8(to_image(gl.draw(*scene, camera, options)));
      ASSERT_EQ(screen.channels, opaque ? 3 : 4);
      ASSERT_EQ(screen.values.size(), encoded.values.size());
      int largest = 0;
      for (std::size_t i = 0; i < screen.values.size(); ++i) {
        const std::size_t alpha = i / 4 * 4 + 3;
        if (!opaque && screen.values[alpha] < 32) continue;  // colors of what can hardly be seen are coarse
        largest = std::max(largest, std::abs(screen.values[i] - encoded.values[i]));
      }
      // Several samples are rounded to 8 bits each, by conversions that drivers may approximate.
      EXPECT_LE(largest, samples == 1 ? 1 : 2) << samples << " samples";
    }
}

TEST(Drawing, NumbersAreThePixelCentresWhateverTheSamples) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  const Camera camera = fitted(made, "iso", small_camera());
  DrawOptions options;
  options.outputs = kEverything;
  const Frame one = gl.draw(*scene, camera, options);
  options.samples = 7;
  options.outputs |= kScreen;
  const Frame seven = gl.draw(*scene, camera, options);
  EXPECT_EQ(one.depth, seven.depth);
  EXPECT_EQ(one.normal, seven.normal);
  EXPECT_EQ(one.primitive, seven.primitive);
  EXPECT_NE(one.color, seven.color);
  EXPECT_EQ(one.stats.covered_pixels, seven.stats.covered_pixels);
}

TEST(Drawing, FarFromTheOriginLooksTheSame) {
  HandMade made = every_kind();
  const Vec3 far{1e7, -2e7, 5e6};  // kilometres away, in millimetres, for a scene of two
  made.place({Mat3{}, far});
  Camera camera = fitted(made, "iso", small_camera());
  const Differences d = draw_and_compare(made, camera);
  EXPECT_LE(d.coverage, 2);
  EXPECT_LE(d.depth_px, kDepthPx);
  EXPECT_LE(d.normal_degrees, kNormalDegrees);
}

TEST(Drawing, OneMicrometreLooksTheSame) {
  HandMade made = every_kind();
  Affine3 tiny;
  tiny.linear = {{1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}};
  made.place(tiny);
  Differences d = draw_and_compare(made, fitted(made, "iso", small_camera()));
  d.curvature = 0;
  expect_same(d);
}

/// Coordinates of the part itself, in a file that has them so, rather than of its placement.
struct Size {
  const char* name;
  double scale;
  Vec3 shift;
};
class AnySize : public ::testing::TestWithParam<Size> {};

TEST_P(AnySize, LooksTheSame) {
  const auto [name, scale, shift] = GetParam();
  HandMade made = moved(every_kind(), scale, shift);
  made.place({});
  for (const bool parallel : {false, true}) {
    Camera camera = small_camera();
    camera.orthographic = parallel;
    camera = fitted(made, "iso", camera);
    const Differences d = draw_and_compare(made, camera);
    EXPECT_GT(d.covered, d.pixels / 50);
    EXPECT_LE(d.coverage, 2);
    EXPECT_LE(d.depth_px, kDepthPx);
    EXPECT_LE(d.normal_degrees, kNormalDegrees);
    EXPECT_LE(d.curvature, kCurvature);
  }
}

INSTANTIATE_TEST_SUITE_P(Drawing, AnySize,
                         ::testing::Values(Size{"TenKilometresAway", 1, {1e7, -2e7, 5e6}},
                                           Size{"OneMicrometre", 5e-4, {}},
                                           Size{"OneMicrometreAMetreAway", 5e-4, {1000, 0, -300}},
                                           Size{"AHundredKilometres", 5e7, {}}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace dupin::testing
