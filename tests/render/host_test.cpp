// Drawing into a host's framebuffer: what is nearer hides the other, both ways, whatever the host's camera
// and its conventions of depth. The host's own scene is a wall at one depth, of which the viewport's left
// half is left out.
#include <GL/glcorearb.h>

#include <cstring>

#include "device.h"
#include "pbuffer_context.h"

namespace dupin::testing {
namespace {

constexpr int kWidth = 120, kHeight = 90;
constexpr double kDistance = 10, kRadius = 2;  // of a sphere in front of the eye
constexpr double kNear = 1, kFar = 30;

struct HostCase {
  const char* name;
  bool perspective = true;
  double wall = 10;             ///< its depth; the sphere is seen between 8 and 10
  bool reversed = false;        ///< near is 1 in the window, and what is greater is nearer
  bool zero_to_one = false;     ///< clip space
  double range[2] = {0, 1};     ///< glDepthRange
  double off_x = 0, off_y = 0;  ///< of the principal point, in half pictures
  int x = 0, y = 0;             ///< the viewport's place
  int samples = 1;
  std::optional<Profile> window;  ///< into the framebuffer 0 of such a context; none: into one of the host's
};
constexpr int kFramebufferWidth = 200, kFramebufferHeight = 150;

class HostPicture {
 public:
  HostPicture(const Context& context, const HostCase& c) : context_(context), case_(c) {
    load(bind_framebuffer_, "glBindFramebuffer"), load(clear_color_, "glClearColor"),
        load(clear_depth_, "glClearDepth");
    load(clear_, "glClear"), load(enable_, "glEnable"), load(disable_, "glDisable"),
        load(scissor_, "glScissor");
    load(depth_func_, "glDepthFunc"), load(depth_range_, "glDepthRange"),
        load(clip_control_, "glClipControl");
    load(read_pixels_, "glReadPixels");
    if (!c.window) make_framebuffer();
  }

  HostView view() const {
    HostView host;
    host.view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    host.projection = projection();
    host.viewport = {case_.x, case_.y, kWidth, kHeight};
    return host;
  }

  /// Background green and far; the wall red, in the right half.
  void draw_own() {
    bind_framebuffer_(GL_FRAMEBUFFER, framebuffer_);
    if (case_.zero_to_one) clip_control_(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    depth_range_(case_.range[0], case_.range[1]);
    enable_(GL_DEPTH_TEST);
    depth_func_(case_.reversed ? GL_GREATER : GL_LESS);
    const double far = window_depth(kFar);
    fill(0, kWidth, {0, 1, 0}, far);
    fill(kWidth / 2, kWidth / 2, {1, 0, 0}, window_depth(case_.wall));
  }

  /// Bottom row first.
  std::vector<std::array<std::uint8_t, 4>> pixels() const {
    std::vector<std::array<std::uint8_t, 4>> result(kWidth * kHeight);
    read_pixels_(case_.x, case_.y, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, result.data());
    return result;
  }
  std::vector<float> depths() const {
    std::vector<float> result(kWidth * kHeight);
    read_pixels_(case_.x, case_.y, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, result.data());
    return result;
  }

  /// By the host's projection, the OpenGL specification's formulas.
  double window_depth(double depth) const {
    const auto p = projection();
    const double z = (p[10] * -depth + p[14]) / (p[11] * -depth + p[15]);
    const double slope = case_.range[1] - case_.range[0];
    return case_.zero_to_one ? case_.range[0] + slope * z : case_.range[0] + slope * (z + 1) / 2;
  }

 private:
  template <class F>
  void load(F& function, const char* name) {
    void* address = context_.proc_address(name);
    std::memcpy(&function, &address, sizeof(address));
  }
  std::array<double, 16> projection() const {
    // Depth near → z0, far → z1 in clip space, those two turned round if reversed.
    const double lowest = case_.zero_to_one ? 0 : -1, z0 = case_.reversed ? 1 : lowest,
                 z1 = case_.reversed ? lowest : 1;
    std::array<double, 16> p{};
    const double aspect = static_cast<double>(kWidth) / kHeight, f = 2.5;
    if (case_.perspective) {
      p[0] = f / aspect, p[5] = f;
      p[8] = case_.off_x, p[9] = case_.off_y;
      // z(depth) = a + b/depth
      const double b = (z0 - z1) / (1 / kNear - 1 / kFar), a = z0 - b / kNear;
      p[10] = -a, p[14] = b, p[11] = -1;
    } else {
      const double half = 4;
      p[0] = 1 / (half * aspect), p[5] = 1 / half;
      p[12] = case_.off_x, p[13] = case_.off_y;
      const double slope = (z1 - z0) / (kFar - kNear);
      p[10] = -slope, p[14] = z0 - slope * kNear, p[15] = 1;
    }
    return p;
  }
  void make_framebuffer() {
    PFNGLGENFRAMEBUFFERSPROC gen = nullptr;
    PFNGLGENRENDERBUFFERSPROC gen_buffers = nullptr;
    PFNGLBINDRENDERBUFFERPROC bind = nullptr;
    PFNGLRENDERBUFFERSTORAGEPROC storage = nullptr;
    PFNGLFRAMEBUFFERRENDERBUFFERPROC attach = nullptr;
    load(gen, "glGenFramebuffers"), load(gen_buffers, "glGenRenderbuffers"), load(bind, "glBindRenderbuffer");
    load(storage, "glRenderbufferStorage"), load(attach, "glFramebufferRenderbuffer");
    GLuint buffers[2];
    gen(1, &framebuffer_);
    gen_buffers(2, buffers);
    bind_framebuffer_(GL_FRAMEBUFFER, framebuffer_);
    const GLenum formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT32F},
                 places[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i < 2; ++i) {
      bind(GL_RENDERBUFFER, buffers[i]);
      storage(GL_RENDERBUFFER, formats[i], kFramebufferWidth, kFramebufferHeight);
      attach(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, buffers[i]);
    }
  }
  /// Columns [first, first + count) of the viewport.
  void fill(int first, int count, const Color& color, double depth) {
    enable_(GL_SCISSOR_TEST);
    scissor_(case_.x + first, case_.y, count, kHeight);
    clear_color_(color.r, color.g, color.b, 1);
    clear_depth_(depth);
    clear_(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    disable_(GL_SCISSOR_TEST);
  }

  const Context& context_;
  const HostCase& case_;
  GLuint framebuffer_ = 0;
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer_ = nullptr;
  PFNGLCLEARCOLORPROC clear_color_ = nullptr;
  PFNGLCLEARDEPTHPROC clear_depth_ = nullptr;
  PFNGLCLEARPROC clear_ = nullptr;
  PFNGLENABLEPROC enable_ = nullptr;
  PFNGLDISABLEPROC disable_ = nullptr;
  PFNGLSCISSORPROC scissor_ = nullptr;
  PFNGLDEPTHFUNCPROC depth_func_ = nullptr;
  PFNGLDEPTHRANGEPROC depth_range_ = nullptr;
  PFNGLCLIPCONTROLPROC clip_control_ = nullptr;
  PFNGLREADPIXELSPROC read_pixels_ = nullptr;
};

/// The depth at which a pixel (bottom row first) sees the sphere; 0 where it does not. `margin`: of the ray
/// from the outline, in units of the radius.
double sphere_depth(const HostView& host, int column, int row, double& margin) {
  const auto& p = host.projection;
  const double x = (column + 0.5) * 2 / kWidth - 1, y = (row + 0.5) * 2 / kHeight - 1;
  Vec3 o{}, d{0, 0, -1};
  if (p[15] == 0) {
    d = {(x + p[8]) / p[0], (y + p[9]) / p[5], -1};
  } else {
    o = {(x - p[12]) / p[0], (y - p[13]) / p[5], 0};
  }
  const Vec3 c = Vec3{0, 0, -kDistance} - o;
  const double dd = dot(d, d), b = dot(d, c), distance = length(c - d * (b / dd));
  margin = distance / kRadius - 1;
  return margin > 0 ? 0 : (b - std::sqrt(b * b - dd * (dot(c, c) - kRadius * kRadius))) / dd;
}

class Hosts : public ::testing::TestWithParam<HostCase> {};

TEST_P(Hosts, WhatIsNearerHidesTheOther) {
  const HostCase& c = GetParam();
  HandMade made;
  made.add(whole_sphere({0, 0, -kDistance + kRadius}, {1, 0, 0}, {0, 1, 0}, kRadius));
  made.model.parts[0].closed = true;
  made.place({});
  auto context = c.window ? create_pbuffer_context(*c.window, kFramebufferWidth, kFramebufferHeight)
                          : create_context(Device::automatic);
  if (c.window && !context.ok()) GTEST_SKIP() << context.status().message;
  TestDevice gl(std::move(context));
  HostPicture picture(*gl.context, c);
  if (c.zero_to_one && !gl.context->proc_address("glClipControl")) GTEST_SKIP() << "no clip control here";
  picture.draw_own();
  const auto scene = gl.upload(made);
  DrawOptions options;
  options.samples = c.samples;
  options.color = Color{0, 0, 1, 1};
  const HostView host = picture.view();
  const Status drawn = gl.renderer->draw_into_host(*scene, host, options);
  ASSERT_TRUE(drawn.ok()) << drawn.message;
  const auto pixels = picture.pixels();
  const auto depths = picture.depths();
  int spheres = 0, walls_before_it = 0;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      double margin = 0;
      const double depth = sphere_depth(host, column, row, margin);
      // Outlines, and where sphere and wall meet, are for rounding and for samples to decide.
      const bool wall = column >= kWidth / 2;
      if (std::abs(margin) < 0.05 || (wall && depth > 0 && std::abs(depth - c.wall) < 0.15)) continue;
      const bool sphere = depth > 0 && !(wall && c.wall < depth);
      const auto& pixel = pixels[static_cast<std::size_t>(row * kWidth + column)];
      spheres += sphere;
      walls_before_it += depth > 0 && !sphere;
      const bool blue = pixel[2] > pixel[0] + 20 && pixel[2] > pixel[1] + 20;
      ASSERT_EQ(blue, sphere) << "pixel " << column << ", " << row;
      if (!sphere) {
        ASSERT_EQ(pixel[0], wall ? 255 : 0) << "pixel " << column << ", " << row;
        ASSERT_EQ(pixel[1], wall ? 0 : 255) << "pixel " << column << ", " << row;
      }
      const double seen = sphere ? depth : wall ? c.wall : kFar;
      ASSERT_NEAR(depths[static_cast<std::size_t>(row * kWidth + column)], picture.window_depth(seen), 2e-4)
          << "pixel " << column << ", " << row;
    }
  EXPECT_GT(spheres, 400);
  if (c.wall < kDistance - kRadius) EXPECT_GT(walls_before_it, 200);
}

INSTANTIATE_TEST_SUITE_P(
    Drawing, Hosts,
    ::testing::Values(
        HostCase{.name = "WallBehind", .wall = 20}, HostCase{.name = "WallBefore", .wall = 5},
        HostCase{.name = "WallThrough", .wall = 8.8},
        HostCase{.name = "Parallel", .perspective = false, .wall = 8.8},
        HostCase{.name = "ParallelReversed", .perspective = false, .wall = 5, .reversed = true},
        HostCase{.name = "Reversed", .wall = 8.8, .reversed = true, .zero_to_one = true},
        HostCase{.name = "ZeroToOne", .wall = 8.8, .zero_to_one = true},
        HostCase{.name = "DepthRange", .wall = 8.8, .range = {0.2, 0.7}},
        HostCase{.name = "OffCentre", .wall = 8.8, .off_x = 0.3, .off_y = -0.2},
        HostCase{
            .name = "ParallelOffCentre", .perspective = false, .wall = 8.8, .off_x = -0.2, .off_y = 0.25},
        HostCase{.name = "PartOfTheFramebuffer", .wall = 8.8, .x = 37, .y = 21},
        HostCase{.name = "SeveralSamples", .wall = 8.8, .samples = 4},
        HostCase{.name = "Window", .wall = 8.8, .window = Profile::core},
        HostCase{.name = "CompatibilityWindow", .wall = 8.8, .x = 11, .window = Profile::compatibility},
        HostCase{.name = "CompatibilityWindowParallel",
                 .perspective = false,
                 .wall = 8.8,
                 .range = {0.1, 0.9},
                 .window = Profile::compatibility},
        HostCase{.name = "CompatibilityWindowSeveralSamples",
                 .wall = 8.8,
                 .samples = 4,
                 .window = Profile::compatibility}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace dupin::testing
