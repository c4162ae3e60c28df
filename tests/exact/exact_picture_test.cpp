// Pictures by the exact ray caster beside those of the tessellated reference and of the DPs.
#include "../../exact/exact_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "../../cad_import/cad_import.h"
#include "../../core/parallel.h"
#include "../../render/metrics.h"
#include "../../render/view.h"
#include "../../sampling/sampler.h"

namespace dupin::exact {
namespace {

constexpr unsigned kOutputs = kColor | kNormal | kDepth | kCurvature | kFace;

Result<Model> load(const std::string& name, double deflection) {
  ImportOptions options;
  options.reader = DUPIN_TEST_READER;
  options.mesh_deflection = deflection;
  return import_cad(std::string(DUPIN_SAMPLES "/") + name, options);
}

Camera camera_of(const Model& model) {
  Camera settings;
  settings.width = settings.height = 192;
  return *fit_view(bounding_box(model), "iso", settings);
}

Image exact_picture(const Model& model, const Camera& camera) {
  PictureOptions options;
  options.outputs = kOutputs;
  return *draw(model, ExactScene(model), camera, options);
}

/// Drawn by the renderer: DPs, or the model's mesh where there are none.
Result<Image> drawn_picture(const Model& model, const DpScene* dps, const Camera& camera) {
  const auto context = create_context(Device::automatic);
  if (!context.ok()) return context.status();
  const auto renderer = Renderer::create((*context)->loader());
  if (!renderer.ok()) return renderer.status();
  const auto scene = (*renderer)->upload(model, dps);
  if (!scene.ok()) return scene.status();
  DrawOptions options;
  options.outputs = kOutputs;
  options.edges = false;
  options.exact_model = &model;
  const Result<Frame> frame = (*renderer)->draw(**scene, camera, options);
  if (!frame.ok()) return frame.status();
  return to_image(*frame);
}

/// Colors count where both show the same face: at the border of two colors, rounding decides.
PictureDifference difference(const Image& exact, Image drawn) {
  const auto &ours = drawn.find("id")->values, &theirs = exact.find("id")->values;
  for (const char* name : {"R", "G", "B"}) {
    auto channel = std::find_if(drawn.channels.begin(), drawn.channels.end(),
                                [&](const Image::Channel& c) { return c.name == name; });
    for (std::size_t i = 0; i < ours.size(); ++i)
      if (ours[i] != theirs[i]) channel->values[i] = exact.find(name)->values[i];
  }
  return *compare(exact, drawn, {});
}

TEST(ExactPicture, IsTheSameAtAnyNumberOfThreads) {
  const Result<Model> model = load("freeform.step", 0);
  ASSERT_TRUE(model.ok());
  const Camera camera = camera_of(*model);
  set_thread_limit(1);
  const Image one = exact_picture(*model, camera);
  set_thread_limit(0);
  const Image all = exact_picture(*model, camera);
  ASSERT_EQ(one.channels.size(), all.channels.size());
  for (std::size_t i = 0; i < one.channels.size(); ++i)
    EXPECT_EQ(std::memcmp(one.channels[i].values.data(), all.channels[i].values.data(), 4 * one.pixels()), 0)
        << one.channels[i].name;
}

// The reference of all comparisons converges to the exact picture: a finer mesh is nearer, down to the
// rounding of 8-bit colors and single-precision depths.
TEST(ExactPicture, TrianglesConvergeToIt) {
  const Result<Model> model = load("bracket.step", 0);
  ASSERT_TRUE(model.ok());
  const Camera camera = camera_of(*model);
  const Image exact = exact_picture(*model, camera);
  double last_depth = 1e9, last_normal = 1e9, last_rmse = 1e9;
  for (const double deflection : {1e-2, 1e-3, 1e-4}) {
    const Result<Model> meshed = load("bracket.step", deflection);
    ASSERT_TRUE(meshed.ok());
    const Result<Image> drawn = drawn_picture(*meshed, nullptr, camera);
    if (!drawn.ok()) GTEST_SKIP() << drawn.status().message;
    const PictureDifference d = difference(exact, *drawn);
    EXPECT_LE(d.geometry->depth_px.p99, last_depth) << deflection;
    EXPECT_LE(d.geometry->normal_degrees.p99, last_normal) << deflection;
    EXPECT_LE(d.color->rmse, last_rmse) << deflection;
    last_depth = d.geometry->depth_px.p99;
    last_normal = d.geometry->normal_degrees.p99;
    last_rmse = d.color->rmse;
  }
  EXPECT_LT(last_depth, 0.05);
  EXPECT_LT(last_normal, 0.3);
  EXPECT_LT(last_rmse, 0.3);
}

TEST(ExactPicture, QuadricDpsConvergeToItWithinTheirTolerance) {
  for (const char* name : {"bracket.step", "freeform.step", "assembly.step"}) {
    const Result<Model> model = load(name, 0);
    ASSERT_TRUE(model.ok());
    const Camera camera = camera_of(*model);
    const Image exact = exact_picture(*model, camera);
    double last = 1e9;
    for (const double tolerance : {0.5, 0.05}) {
      SamplingOptions sampling;
      sampling.camera = camera;
      sampling.tolerance_px = tolerance;
      sampling.normal_tolerance = tolerance * 0.5 * 3.14159265358979323846 / 180;
      const Result<DpScene> dps = sample_quadric_dps(*model, sampling);
      ASSERT_TRUE(dps.ok());
      const Result<Image> drawn = drawn_picture(*model, &*dps, camera);
      if (!drawn.ok()) GTEST_SKIP() << drawn.status().message;
      const PictureDifference d = difference(exact, *drawn);
      EXPECT_EQ(d.geometry->holes, 0U) << name;
      EXPECT_EQ(d.geometry->extra, 0U) << name;
      EXPECT_LE(d.silhouette, d.covered_a / 2000 + 4) << name;
      EXPECT_LT(d.geometry->depth_px.p99, tolerance) << name;
      EXPECT_LT(d.geometry->normal_degrees.p99, tolerance * 0.5 + 0.02) << name;  // float normals
      EXPECT_LE(d.color->rmse, last) << name;
      last = d.color->rmse;
    }
    EXPECT_LT(last, 0.3) << name;
  }
}

// What both draw besides the surface: the same camera, light, colors and face numbers.
TEST(ExactPicture, ColorsFacesAndCurvaturesAreThoseOfTheRenderer) {
  const Result<Model> model = load("bracket.step", 0);
  ASSERT_TRUE(model.ok());
  const Camera camera = camera_of(*model);
  const Image exact = exact_picture(*model, camera);
  SamplingOptions sampling;
  sampling.camera = camera;
  const Result<DpScene> dps = sample_quadric_dps(*model, sampling);
  ASSERT_TRUE(dps.ok());
  const Result<Image> drawn = drawn_picture(*model, &*dps, camera);
  if (!drawn.ok()) GTEST_SKIP() << drawn.status().message;
  std::size_t faces = 0, curvatures = 0, covered = 0;
  const auto &id_a = exact.find("id")->values, &id_b = drawn->find("id")->values;
  const auto &k_a = exact.find("k1")->values, &k_b = drawn->find("k1")->values;
  for (std::size_t i = 0; i < exact.pixels(); ++i) {
    if (id_a[i] == 0 || id_b[i] == 0) continue;
    ++covered;
    faces += id_a[i] != id_b[i];
    if (id_a[i] == id_b[i]) curvatures += std::abs(k_a[i] - k_b[i]) > 1e-3 * std::abs(k_a[i]) + 1e-5;
  }
  EXPECT_LE(faces, covered / 1000);
  EXPECT_LE(curvatures, covered / 1000);
  EXPECT_LT(difference(exact, *drawn).color->rmse, 0.1);
}

}  // namespace
}  // namespace dupin::exact
