// Layers beside quadric DPs and triangles: hidden and hiding, numbers, samples, a host's framebuffer.
#include "../../render/view.h"
#include "device.h"
#include "quad_layer.h"

namespace dupin::testing {
namespace {

constexpr int kSize = 120;

/// From above, 12 units wide: pixel (c, r) sees (c − 59.5, 59.5 − r) / 10.
Camera from_above() {
  Camera camera;
  camera.orthographic = true;
  camera.ortho_height = 12;
  camera.eye = {0, 0, 10};
  camera.target = {};
  camera.up = {0, 1, 0};
  camera.width = camera.height = kSize;
  return camera;
}
std::size_t pixel_at(double x, double y) {
  const int column = static_cast<int>(std::lround(10 * x + 59.5)),
            row = static_cast<int>(std::lround(59.5 - 10 * y));
  return static_cast<std::size_t>(row * kSize + column);
}

/// Part 0 with a plate of DPs at height 0 and x in [-4, 0]; part 1 a square of triangles at 0, x in [0, 4];
/// in part 2 of the layer a square above both and one below, each over half of y.
struct MixedScene {
  HandMade made;
  std::vector<Quad> quads;

  MixedScene() {
    made.add(plane_rectangle({-2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 8));
    made.model.parts.resize(3);
    made.dps.parts.resize(3);
    Part& triangles = made.model.parts[1];
    triangles.mesh.positions = {{0, -4, 0}, {4, -4, 0}, {4, 4, 0}, {0, 4, 0}};
    triangles.mesh.normals.assign(4, {0, 0, 1});
    triangles.mesh.triangles = {0, 1, 2, 0, 2, 3};
    triangles.mesh.faces = {0, 0};
    Part& quads_part = made.model.parts[2];
    quads_part.faces.resize(2);
    quads_part.faces[0].color = Color{1, 0, 0, 1};
    quads_part.faces[1].color = Color{0, 1, 0, 1};
    quads.push_back({2, 0, {0, 2, 1}, {3, 0, 0}, {0, 1, 0}, 0.5F, -0.25F});
    quads.push_back({2, 1, {0, -2, -1}, {5, 0, 0}, {0, 1, 0}, 2, 1});
    for (std::uint32_t i = 0; i < 3; ++i) {
      made.model.instances.emplace_back();
      made.model.instances.back().part = i;
    }
  }
  SceneContent content() const { return {&made.dps, {make_quad_layer(quads)}}; }
};

struct Drawn {
  TestDevice gl;
  std::unique_ptr<Scene> scene;
  explicit Drawn(const MixedScene& mixed) {
    auto made = gl.renderer->upload(mixed.made.model, mixed.content());
    EXPECT_TRUE(made.ok()) << made.status().message;
    scene = std::move(*made);
  }
  Frame draw(const DrawOptions& options) { return gl.draw(*scene, from_above(), options); }
};

DrawOptions everything() {
  DrawOptions options;
  options.outputs = kEverything;
  options.edges = false;
  return options;
}

TEST(Layers, HideAndAreHiddenByDpsAndTriangles) {
  const MixedScene mixed;
  Drawn drawn(mixed);
  const Frame frame = drawn.draw(everything());
  // Primitives: DP 1, triangles 2 and 3, quads 4 and 5; faces: DP 1, mesh 2, quads 3 and 4.
  for (const double x : {-2.0, 2.0}) {
    EXPECT_EQ(frame.primitive[pixel_at(x, 2)], 4U);
    EXPECT_EQ(frame.face[pixel_at(x, 2)], 3U);
    EXPECT_FLOAT_EQ(frame.depth[pixel_at(x, 2)], 9);
    EXPECT_EQ(frame.face[pixel_at(x, -2)], x < 0 ? 1U : 2U);
    EXPECT_FLOAT_EQ(frame.depth[pixel_at(x, -2)], 10);
  }
  EXPECT_EQ(frame.primitive[pixel_at(4.5, -2)], 5U);
  EXPECT_FLOAT_EQ(frame.depth[pixel_at(4.5, -2)], 11);
  EXPECT_EQ(frame.primitive[pixel_at(4.5, 2)], 0U);
  EXPECT_TRUE(std::isinf(frame.depth[pixel_at(4.5, 2)]));
}

TEST(Layers, CountInWhatASceneAndAFrameAreMadeOf) {
  const MixedScene mixed;
  Drawn drawn(mixed);
  EXPECT_EQ(drawn.scene->info().primitives, 5U);
  EXPECT_EQ(drawn.scene->info().placed_primitives, 5U);
  EXPECT_EQ(drawn.scene->info().drawn_faces, 4U);
  EXPECT_EQ(drawn.scene->box().lo.z, -1);
  EXPECT_EQ(drawn.scene->box().hi.z, 1);
  const Frame frame = drawn.draw(everything());
  EXPECT_EQ(frame.stats.primitives, 5U);
  // The plates cover 8 × 8 units and the lower quad a unit on either side of them, 2 high.
  EXPECT_EQ(frame.stats.covered_pixels, 80U * 80U + 2U * 10U * 20U);
  const std::size_t bytes = drawn.scene->info().bytes;
  MixedScene without = mixed;
  without.quads.clear();
  EXPECT_EQ(bytes, Drawn(without).scene->info().bytes + 2 * 48);
}

TEST(Layers, FillEveryPictureOfNumbers) {
  const MixedScene mixed;
  Drawn drawn(mixed);
  const Frame frame = drawn.draw(everything());
  const std::size_t at = pixel_at(1.05, 2.05);
  const auto vector = [&](const std::vector<float>& values) {
    return Vec3{values[3 * at], values[3 * at + 1], values[3 * at + 2]};
  };
  EXPECT_NEAR(distance(vector(frame.normal), {0, 0, 1}), 0, 1e-6);
  EXPECT_NEAR(distance(vector(frame.direction), {1, 0, 0}), 0, 1e-6);
  EXPECT_NEAR(distance(vector(frame.position), {1.05, 2.05, 1}), 0, 1e-5);
  EXPECT_EQ(frame.curvature[2 * at], 0.5F);
  EXPECT_EQ(frame.curvature[2 * at + 1], -0.25F);
  EXPECT_GT(frame.color[4 * at], 10 * frame.color[4 * at + 1]) << "the face is red";
}

TEST(Layers, AreSampledLikeAllElse) {
  const MixedScene mixed;
  Drawn drawn(mixed);
  DrawOptions options = everything();
  const Frame one = drawn.draw(options);
  options.samples = 16;
  // The quad's side lies half way through a pixel.
  MixedScene shifted;
  shifted.quads[0].u.x = 3.05;
  shifted.made.dps.parts[0].dps.clear();
  shifted.made.model.parts[1].mesh = {};
  Drawn half(shifted);
  const Frame many = half.draw(options);
  for (int k = 0; k < 3; ++k) {
    const std::size_t inside = 4 * pixel_at(1.05, 2.05) + static_cast<std::size_t>(k),
                      side = 4 * pixel_at(3.05, 2.05) + static_cast<std::size_t>(k);
    EXPECT_NEAR(many.color[inside], one.color[inside], 2e-3);
    EXPECT_NEAR(many.color[side], 0.5F * (many.color[inside] + 1), 0.07F);
  }
}

TEST(Layers, ArePlacedAndNumberedWithTheirParts) {
  MixedScene mixed;
  Affine3 mirrored;
  mirrored.linear = {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  mirrored.translation = {0, 0, 0.5};
  Instance again;
  again.part = 2;
  again.to_world = mirrored;
  again.color = Color{0, 0, 1, 1};
  mixed.made.model.instances.push_back(again);
  Drawn drawn(mixed);
  const Frame frame = drawn.draw(everything());
  EXPECT_EQ(frame.primitive[pixel_at(-2, -2)], 6U);
  EXPECT_EQ(frame.face[pixel_at(-2, -2)], 5U);
  EXPECT_FLOAT_EQ(frame.depth[pixel_at(-2, -2)], 8.5F);
  EXPECT_EQ(frame.primitive[pixel_at(4.5, 2)], 7U);
  EXPECT_EQ(frame.primitive[pixel_at(-2, 2)], 4U);
  EXPECT_EQ(frame.stats.primitives, 7U);
}

TEST(Layers, LookTheSameFarFromTheOrigin) {
  const MixedScene near;
  MixedScene far = near;
  const Vec3 shift{1e7, -2e7, 5e6};
  for (Instance& instance : far.made.model.instances) instance.to_world.translation = shift;
  Camera camera = from_above();
  const Frame there = Drawn(near).draw(everything());
  Drawn drawn(far);
  camera.eye += shift;
  camera.target += shift;
  const Frame frame = drawn.gl.draw(*drawn.scene, camera, everything());
  EXPECT_EQ(frame.primitive[pixel_at(2, 2)], 4U);
  EXPECT_NEAR(frame.depth[pixel_at(2, 2)], 9, 1e-5);
  EXPECT_EQ(frame.primitive, there.primitive);
}

TEST(Layers, SeveralKeepTheirNumbersApart) {
  MixedScene mixed;
  TestDevice gl;
  SceneContent content{&mixed.made.dps, {}};
  for (const Quad& quad : mixed.quads) content.layers.push_back(make_quad_layer({quad}));
  const auto scene = gl.renderer->upload(mixed.made.model, content);
  ASSERT_TRUE(scene.ok());
  const Frame frame = gl.draw(**scene, from_above(), everything());
  EXPECT_EQ(frame.primitive[pixel_at(2, 2)], 4U);
  EXPECT_EQ(frame.primitive[pixel_at(4.5, -2)], 5U);
  EXPECT_EQ(frame.face[pixel_at(4.5, -2)], 4U);
  while (content.layers.size() <= kMostLayers) content.layers.push_back(make_quad_layer({}));
  const auto refused = gl.renderer->upload(mixed.made.model, content);
  EXPECT_EQ(refused.status().code, StatusCode::limit);
}

TEST(Layers, MayNotNameFacesThatThereAreNot) {
  MixedScene mixed;
  mixed.quads[1].face = 7;
  TestDevice gl;
  const auto scene = gl.renderer->upload(mixed.made.model, mixed.content());
  EXPECT_EQ(scene.status().code, StatusCode::invalid_argument);
}

/// A framebuffer as a host has it, with a color and a depth picture.
struct HostPicture {
  const Gl gl;
  GlFramebuffer framebuffer;
  GlTexture color, depth;
  explicit HostPicture(const Context& context)
      : gl(*load_gl(context.loader())), framebuffer(gl), color(gl), depth(gl) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl.BindTexture(GL_TEXTURE_2D, color.name());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl.BindTexture(GL_TEXTURE_2D, depth.name());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, kSize, kSize, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                  nullptr);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.name(), 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.name(), 0);
    gl.Enable(GL_DEPTH_TEST);
  }
  std::array<std::uint8_t, 4> pixel(double x, double y) {
    std::array<std::uint8_t, 4> rgba{};
    const auto at = static_cast<int>(pixel_at(x, y));
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl.ReadPixels(at % kSize, kSize - 1 - at / kSize, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
};

TEST(Layers, AreDrawnAgainstAHostsDepth) {
  const MixedScene mixed;
  Drawn drawn(mixed);
  for (const float host_depth : {0.98F, 0.5F}) {  // behind all, and before all
    HostPicture host(*drawn.gl.context);
    const float blue[4] = {0, 0, 1, 1};
    host.gl.ClearBufferfv(GL_COLOR, 0, blue);
    host.gl.ClearBufferfv(GL_DEPTH, 0, &host_depth);
    HostView view{};
    view.view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -10, 1};
    view.projection = {1 / 6.0, 0, 0, 0, 0, 1 / 6.0, 0, 0, 0, 0, -1 / 6.0, 0, 0, 0, -1, 1};  // depths 0 … 12
    view.viewport = {0, 0, kSize, kSize};
    ASSERT_TRUE(drawn.gl.renderer->draw_into_host(*drawn.scene, view, everything()).ok());
    EXPECT_EQ(host.gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
    const auto upper = host.pixel(2, 2);
    if (host_depth > 0.9F) {
      EXPECT_GT(upper[0], 150);
      EXPECT_LT(upper[2], 100);
    } else {
      EXPECT_EQ(upper[2], 255);
      EXPECT_EQ(upper[0], 0);
    }
    EXPECT_EQ(host.pixel(5.5, 5.5)[2], 255);
  }
}

}  // namespace
}  // namespace dupin::testing
