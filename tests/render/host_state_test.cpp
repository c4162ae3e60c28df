// A host's OpenGL state is the same after every call as before it, however unusual; and no call depends on
// it.
#include <functional>

#include "../../render/view.h"
#include "device.h"
#include "host_state.h"
#include "pbuffer_context.h"

namespace dupin::testing {
namespace {

constexpr int kSize = 64;

HostView host_view() {
  HostView host;
  host.view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -8, 1};
  host.projection = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.1, -1, 0, 0, -2.2, 0};
  host.viewport = {0, 0, kSize, kSize};
  return host;
}

struct HostScene {
  HandMade made = every_kind();
  Camera camera;
  HostScene() {
    made.place({});
    // A part of triangles beside the DPs.
    made.model.parts.emplace_back();
    made.dps.parts.emplace_back();
    TriangleMesh& mesh = made.model.parts[1].mesh;
    mesh.positions = {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles = {0, 1, 2};
    mesh.faces = {0};
    made.model.instances.emplace_back();
    made.model.instances.back().part = 1;
    Camera settings;
    settings.width = settings.height = kSize;
    Box3 box = made.model.parts[0].box;
    box.add(Vec3{1, 1, 3});
    camera = *fit_view(box, "iso", settings);
  }
};

struct HostKind {
  const char* name;
  std::function<Result<std::unique_ptr<Context>>()> create;
  bool window = false;  ///< draws into the context's own framebuffer
};
class HostState : public ::testing::TestWithParam<HostKind> {};

TEST_P(HostState, EveryCallPutsItBack) {
  const HostScene scene;
  auto context = GetParam().create();
  if (!context.ok()) GTEST_SKIP() << context.status().message;
  set_unusual_state(**context, kSize, kSize);
  if (GetParam().window) draw_into_window(**context);
  ASSERT_EQ(gl_error(**context), 0u);
  const GlState before = gl_state(**context);
  ASSERT_EQ(gl_error(**context), 0u);
  const auto expect_unchanged = [&](const char* call) {
    EXPECT_EQ(gl_error(**context), 0u) << call;
    EXPECT_EQ(differences(before, gl_state(**context)), "") << "after " << call;
  };
  {
    const auto renderer = Renderer::create((*context)->loader());
    ASSERT_TRUE(renderer.ok()) << renderer.status().message;
    expect_unchanged("create");
    const auto uploaded = (*renderer)->upload(scene.made.model, &scene.made.dps);
    ASSERT_TRUE(uploaded.ok()) << uploaded.status().message;
    expect_unchanged("upload");
    for (const int samples : {1, 4}) {
      DrawOptions options;
      options.samples = samples;
      options.outputs = kEverything | kScreen;
      ASSERT_TRUE((*renderer)->draw(**uploaded, scene.camera, options).ok());
      expect_unchanged("draw");
      options.outputs = kScreen;
      ASSERT_TRUE((*renderer)->draw_only(**uploaded, scene.camera, options).ok());
      expect_unchanged("draw_only");
      ASSERT_TRUE((*renderer)->draw_into_host(**uploaded, host_view(), options).ok());
      expect_unchanged("draw_into_host");
    }
  }
  expect_unchanged("destruction");
}

TEST_P(HostState, ChangesNoPicture) {
  const HostScene scene;
  DrawOptions options;
  options.outputs = kEverything | kScreen;
  const auto draw = [&](bool unusual) {
    Frame frame;
    auto context = GetParam().create();
    if (!context.ok()) return frame;
    if (unusual) set_unusual_state(**context, kSize, kSize);
    const auto renderer = Renderer::create((*context)->loader());
    if (!renderer.ok()) return frame;
    const auto uploaded = (*renderer)->upload(scene.made.model, &scene.made.dps);
    if (!uploaded.ok()) return frame;
    auto drawn = (*renderer)->draw(**uploaded, scene.camera, options);
    return drawn.ok() ? std::move(*drawn) : frame;
  };
  const Frame usual = draw(false), unusual = draw(true);
  if (usual.width == 0) GTEST_SKIP() << "no such device here";
  ASSERT_GT(usual.stats.covered_pixels, 500u);
  EXPECT_EQ(usual.screen, unusual.screen);
  EXPECT_EQ(usual.color, unusual.color);
  EXPECT_EQ(usual.depth, unusual.depth);
  EXPECT_EQ(usual.normal, unusual.normal);
  EXPECT_EQ(usual.face, unusual.face);
}

INSTANTIATE_TEST_SUITE_P(
    Drawing, HostState,
    ::testing::Values(
        HostKind{"Egl", [] { return create_context(Device::egl); }},
        HostKind{"OsMesa", [] { return create_context(Device::osmesa); }},
        HostKind{"Window", [] { return create_pbuffer_context(Profile::core, kSize, kSize); }, true},
        HostKind{"Compatibility",
                 [] { return create_pbuffer_context(Profile::compatibility, kSize, kSize); }},
        HostKind{"CompatibilityWindow",
                 [] { return create_pbuffer_context(Profile::compatibility, kSize, kSize); }, true}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace dupin::testing
