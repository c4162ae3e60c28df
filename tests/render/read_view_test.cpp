// Reading a part of a host's view, for picking, and what a frame says of its bounds.
#include "../../render/view.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// gluLookAt and gluPerspective (or glOrtho) of a camera, with the principal point moved off the middle.
HostView host_view(const Camera& camera, double off_x, double off_y) {
  const auto [x, y, z] = camera_axes(camera);
  const Vec3& e = camera.eye;
  HostView host;
  host.view = {x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, -dot(x, e), -dot(y, e), -dot(z, e), 1};
  const double near = 0.01, far = 1000, aspect = static_cast<double>(kWidth) / kHeight;
  if (camera.orthographic) {
    const double s = 2 / camera.ortho_height;
    host.projection = {s / aspect, 0, 0, 0, 0, s, 0, 0, 0, 0, -2 / (far - near), 0, off_x, off_y, 0, 1};
  } else {
    const double f = 1 / std::tan(camera.fov_degrees * 3.14159265358979323846 / 360);
    host.projection = {f / aspect,
                       0,
                       0,
                       0,
                       0,
                       f,
                       0,
                       0,
                       off_x,
                       off_y,
                       (far + near) / (near - far),
                       -1,
                       0,
                       0,
                       2 * far * near / (near - far),
                       0};
  }
  host.viewport = {7, 3, kWidth, kHeight};
  return host;
}

class PartOfAView : public ::testing::TestWithParam<bool> {};

TEST_P(PartOfAView, HasTheSamePixelsAsTheWhole) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  Camera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.orthographic = GetParam();
  camera = *fit_view(scene->box(), "iso", camera);
  const HostView host = host_view(camera, 0.1, -0.07);
  DrawOptions options;
  options.outputs = kFace | kDepth | kNormal | kPosition;
  const auto whole = gl.renderer->read_host_view(*scene, host, {0, 0, kWidth, kHeight}, options);
  ASSERT_TRUE(whole.ok()) << whole.status().message;
  std::size_t seen = 0, other = 0;
  const std::array<int, 4> rectangles[] = {
      {50, 40, 60, 50}, {80, 60, 1, 1}, {-5, 90, 30, 40}, {75, 55, 1, 1}};
  for (const auto& [x, y, width, height] : rectangles) {
    const auto part = gl.renderer->read_host_view(*scene, host, {x, y, width, height}, options);
    ASSERT_TRUE(part.ok()) << part.status().message;
    ASSERT_EQ(part->width, width);
    ASSERT_EQ(part->face.size(), static_cast<std::size_t>(width * height));
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const int column = x + c, row = kHeight - y - height + r;
        if (column < 0 || row < 0) continue;
        const auto i = static_cast<std::size_t>(r * width + c),
                   j = static_cast<std::size_t>(row * kWidth + column);
        seen += part->face[i] != 0;
        other += part->face[i] != whole->face[j];
        if (part->face[i] == 0 || part->face[i] != whole->face[j]) continue;
        EXPECT_NEAR(part->depth[i], whole->depth[j], 1e-3 * whole->depth[j]);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(part->position[3 * i + k], whole->position[3 * j + k], 0.01);
      }
  }
  EXPECT_GT(seen, 800U);
  EXPECT_LE(other, 2U);
}

INSTANTIATE_TEST_SUITE_P(Hosts, PartOfAView, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Parallel" : "Perspective"; });

TEST(PartOfAView, NeedsAPixelAndACamera) {
  HandMade made = every_kind();
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  HostView host = host_view(*fit_view(scene->box(), "top", {}), 0, 0);
  EXPECT_EQ(gl.renderer->read_host_view(*scene, host, {0, 0, 0, 4}, {}).status().code,
            StatusCode::invalid_argument);
  host.view.fill(0);
  EXPECT_EQ(gl.renderer->read_host_view(*scene, host, {0, 0, 1, 1}, {}).status().code,
            StatusCode::invalid_argument);
}

TEST(FrameStats, BoundsAreInPixelsAndGrowWithTheZoom) {
  HandMade made;
  made.add(bent_square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1, 0.2, {0, 0, 0}, 1)).bound = 0.003;
  QuadricDp& aside = made.add(bent_square({40, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1, 0.2, {0, 0, 0}, 1));
  aside.bound = 0.1;
  made.place({});
  TestDevice gl;
  const auto scene = gl.upload(made);
  Camera camera;
  camera.orthographic = true;
  camera.eye = {0, 0, 10};
  camera.target = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.width = camera.height = 100;
  camera.ortho_height = 4;
  const auto bound = [&] { return gl.renderer->draw_only(*scene, camera, {})->bound_px; };
  EXPECT_NEAR(bound(), 0.003 * 25, 1e-6);
  camera.ortho_height = 0.5;
  EXPECT_NEAR(bound(), 0.003 * 200, 1e-6);
  camera.ortho_height = 100;
  EXPECT_NEAR(bound(), 0.1, 1e-6);  // the other is in view
}

}  // namespace
}  // namespace dupin::testing
