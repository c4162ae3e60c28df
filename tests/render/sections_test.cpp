// Models cut open by planes.
#include "../../render/view.h"
#include "device.h"
#include "oracle.h"
#include "quad_layer.h"

namespace dupin::testing {
namespace {

Camera camera_for(const Box3& box, bool orthographic) {
  Camera camera;
  camera.width = 240;
  camera.height = 180;
  camera.orthographic = orthographic;
  return *fit_view(box, "iso", camera);
}

/// Through the scene's middle, one slanted, one along an axis.
Sections two_sections(const Box3& box) {
  const Vec3 c = box.center();
  const Vec3 slanted{1, 0.4, -0.3}, across{0, 2, 0};
  return {{slanted, -dot(slanted, c)}, {across, -dot(across, c) + 0.2}};
}

class Cut : public ::testing::TestWithParam<bool> {};

TEST_P(Cut, MatchesTheRayCaster) {
  HandMade made = every_kind();
  made.place({});
  made.place(rigid({0, 0, 1}, 0.4, {1.5, 1, 0.5}));
  TestDevice gl;
  const auto scene = gl.upload(made);
  const Camera camera = camera_for(scene->box(), GetParam());
  DrawOptions options;
  options.outputs = kEverything;
  options.sections = two_sections(scene->box());
  const Differences cut = differences(made, camera, gl.draw(*scene, camera, options), options.sections);
  EXPECT_GT(cut.covered, 300);
  EXPECT_LE(cut.coverage, 4);
  EXPECT_LE(cut.other_primitive, 4);
  EXPECT_LE(cut.depth_px, 0.02);
  EXPECT_LE(cut.normal_degrees, 0.03);
  options.sections.pop_back();
  const Differences one = differences(made, camera, gl.draw(*scene, camera, options), options.sections);
  EXPECT_GT(one.covered, cut.covered);
  EXPECT_LE(one.coverage, 4);
}

INSTANTIATE_TEST_SUITE_P(Sections, Cut, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Parallel" : "Perspective"; });

struct Pattern {
  std::size_t inner = 0, hatched = 0;
};

/// A sphere of radius 1 around the origin of which the half that is nearer to the viewer is cut away.
Pattern half_sphere(bool closed, int samples) {
  HandMade made;
  made.add(whole_sphere({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1));
  made.model.parts[0].closed = closed;
  made.model.parts[0].color = Color{0.5F, 0.5F, 0.5F, 1};
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  Camera camera = camera_for(scene->box(), true);
  DrawOptions options;
  options.outputs = kColor | kNormal | kFace | kPosition;
  options.edges = false;
  options.samples = samples;
  const Vec3 towards = normalized(camera.eye - camera.target);
  options.sections = {{-towards, 0}};
  const Frame frame = gl.draw(*scene, camera, options);
  Pattern pattern;
  const float tones[] = {0.5F * 0.35F, 0.5F * 0.8F};
  for (std::size_t i = 0; i < frame.face.size(); ++i) {
    if (frame.face[i] == 0) continue;
    const Vec3 n{frame.normal[3 * i], frame.normal[3 * i + 1], frame.normal[3 * i + 2]};
    const Vec3 p{frame.position[3 * i], frame.position[3 * i + 1], frame.position[3 * i + 2]};
    EXPECT_LT(dot(n, towards), 0);
    EXPECT_NEAR(length(n - p), 0, 1e-3);
    ++pattern.inner;
    const float red = frame.color[4 * i];
    pattern.hatched += std::abs(red - tones[0]) < 0.01F || std::abs(red - tones[1]) < 0.01F;
  }
  return pattern;
}

TEST(Sections, OneLooksIntoACutSolidByHatches) {
  const Pattern solid = half_sphere(true, 1), sheet = half_sphere(false, 1);
  EXPECT_GT(solid.inner, 5000U);
  EXPECT_EQ(solid.inner, sheet.inner);
  EXPECT_GT(solid.hatched, solid.inner * 7 / 10);
  EXPECT_LT(sheet.hatched, sheet.inner / 4);
  EXPECT_GT(half_sphere(true, 4).hatched, solid.inner / 2);
}

TEST(Sections, CutTrianglesAndLayersToo) {
  HandMade made;
  made.model.parts.resize(2);
  made.dps.parts.resize(2);
  TriangleMesh& mesh = made.model.parts[0].mesh;
  mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.faces = {0, 0};
  const std::vector<Quad> quads = {{1, 0, {0, 0, 1}, {2, 0, 0}, {0, 1, 0}, 0.5F, -0.25F}};
  made.model.parts[1].faces.resize(1);
  for (std::uint32_t i = 0; i < 2; ++i) made.model.instances.emplace_back().part = i;
  TestDevice gl;
  const auto scene = gl.renderer->upload(made.model, SceneContent{&made.dps, {make_quad_layer(quads)}});
  ASSERT_TRUE(scene.ok()) << scene.status().message;
  const Camera camera = camera_for((*scene)->box(), false);
  DrawOptions options;
  options.outputs = kPosition | kFace | kDepth;
  const Frame whole = gl.draw(**scene, camera, options);
  options.sections = {{{1, 0.5, 0.25}, -0.3}};
  const Frame cut = gl.draw(**scene, camera, options);
  std::size_t kept[3] = {}, seen[3] = {};
  for (std::size_t i = 0; i < cut.face.size(); ++i) {
    const Vec3 p{whole.position[3 * i], whole.position[3 * i + 1], whole.position[3 * i + 2]};
    const double value = p.x + 0.5 * p.y + 0.25 * p.z - 0.3;
    ++seen[whole.face[i]];
    if (whole.face[i] == 0 || std::abs(value) < 0.02) continue;
    if (value > 0) {
      EXPECT_EQ(cut.face[i], whole.face[i]);
      ++kept[cut.face[i]];
    } else {
      EXPECT_NE(cut.face[i], whole.face[i]);
    }
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_GT(kept[i], seen[i] / 5);
    EXPECT_LT(kept[i], seen[i] * 4 / 5);
  }
}

TEST(Sections, MustHaveADirectionAndAreLimitedInNumber) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  const Camera camera = camera_for(scene->box(), false);
  const auto code = [&](Sections sections) {
    DrawOptions options;
    options.sections = std::move(sections);
    return gl.renderer->draw(*scene, camera, options).status().code;
  };
  EXPECT_EQ(code({{{0, 0, 0}, 1}}), StatusCode::invalid_argument);
  EXPECT_EQ(code({{{0, 0, 1}, std::numeric_limits<double>::infinity()}}), StatusCode::invalid_argument);
  EXPECT_EQ(code(Sections(kMostSections + 1, {{0, 0, 1}, 0})), StatusCode::invalid_argument);
  EXPECT_EQ(code(Sections(kMostSections, {{0, 0, 1}, 100})), StatusCode::ok);
}

}  // namespace
}  // namespace dupin::testing
