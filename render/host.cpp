// Drawing into a host's framebuffer: a picture of our own, put there pixel by pixel against the host's depth
// buffer.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "gl_state.h"
#include "renderer_impl.h"

namespace dupin {
namespace {

/// Window depth as a function of the depth along the view axis, x + y·depth + z/depth, for the host's
/// projection and conventions.
std::array<double, 3> host_depth_terms(const HostView& host, const ViewRays& view,
                                       const GlStateGuard& state) {
  const auto& p = host.projection;
  // With the host's z = −scale·depth, clip z is p10 z + p14 and clip w −z (or p15).
  std::array<double, 3> ndc;
  if (view.perspective) {
    ndc = {p[10] / p[11], 0, -p[14] / (view.scale * p[11])};
  } else {
    ndc = {p[14] / p[15], -p[10] * view.scale / p[15], 0};
  }
  const auto [near, far] = state.depth_range();
  const double slope = state.clip_zero_to_one() ? far - near : (far - near) / 2;
  const double offset = state.clip_zero_to_one() ? near : (far + near) / 2;
  return {ndc[0] * slope + offset, ndc[1] * slope, ndc[2] * slope};
}

/// The depth buffer is that of the last sample, which is the pixel's centre only if there is one.
bool own_depth_picture(const DrawOptions& options) {
  return options.samples > 1;
}

/// What is drawn of a frame that the host's framebuffer gets.
DrawOptions for_a_host(const DrawOptions& options) {
  DrawOptions own = options;
  own.outputs = own_depth_picture(own) ? kScreen | kDepth : kScreen;
  own.background.reset();
  return own;
}

/// What may be drawn beyond the box of the geometry: edges, points.
constexpr double kMarginPx = 10;

/// The pixels x, y, width, height, from the lower left corner, that what is in the box may cover.
std::array<int, 4> covered(const Box3& box, const ViewRays& view) {
  double lo_x = view.width, lo_y = view.height, hi_x = 0, hi_y = 0;
  for (int i = 0; i < 8 && !box.empty(); ++i) {
    const Vec3 p = box.corner(i) - view.eye;
    const double depth = dot(p, view.forward), z = view.perspective ? depth : 1;
    // What reaches behind the eye may be anywhere.
    if (!(z > 0) || !std::isfinite(depth)) return {0, 0, view.width, view.height};
    const double x = ((dot(p, view.right) / z - view.ox) / view.sx + 1) / 2 * view.width;
    const double y = (1 - (dot(p, view.up) / z - view.oy) / view.sy) / 2 * view.height;
    lo_x = std::min(lo_x, x), hi_x = std::max(hi_x, x);
    lo_y = std::min(lo_y, y), hi_y = std::max(hi_y, y);
  }
  const auto pixel = [](double at, int size) { return static_cast<int>(std::clamp<double>(at, 0, size)); };
  const int x = pixel(lo_x - kMarginPx, view.width), y = pixel(lo_y - kMarginPx, view.height);
  return {x, y, std::max(pixel(hi_x + kMarginPx, view.width) - x, 0),
          std::max(pixel(hi_y + kMarginPx, view.height) - y, 0)};
}

/// Of a rectangle of pixels, what is in the other too.
std::array<int, 4> common(const std::array<int, 4>& a, const std::array<int, 4>& b) {
  const int x = std::max(a[0], b[0]), y = std::max(a[1], b[1]);
  return {x, y, std::max(std::min(a[0] + a[2], b[0] + b[2]) - x, 0),
          std::max(std::min(a[1] + a[3], b[1] + b[3]) - y, 0)};
}

}  // namespace

Status Renderer::Impl::composite(const HostView& host, const ViewRays& view, const Box3& box,
                                 const DrawOptions& options, const GlStateGuard& state) {
  std::array<int, 4> pixels = covered(box, view);
  pixels[0] += host.viewport[0], pixels[1] += host.viewport[1];
  if (const auto scissor = state.scissor()) pixels = common(pixels, *scissor);
  const bool depth_picture = own_depth_picture(options);
  ProgramText text{
      {"screen.vert"}, {"composite.frag"}, {}, {}, {{"colors", kVerticesUnit}, {"depths", kIndicesUnit}}};
  if (depth_picture) text.defines.push_back("DEPTH_PICTURE");
  const auto name = program(depth_picture ? "composite by depth" : "composite", text);
  if (!name) return name.status();
  set_view(*name, view);
  const auto uniform = [&](const char* n) { return gl->GetUniformLocation(*name, n); };
  gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, state.draw_framebuffer());
  const auto terms = host_depth_terms(host, view, state);
  const auto [near, far] = state.depth_range();
  gl->Uniform3f(uniform("host_depth"), static_cast<float>(terms[0]), static_cast<float>(terms[1]),
                static_cast<float>(terms[2]));
  gl->Uniform2f(uniform("host_range"), static_cast<float>(std::min(near, far)),
                static_cast<float>(std::max(near, far)));
  gl->Uniform3i(uniform("place"), host.viewport[0], host.viewport[1], host.viewport[3]);
  gl->Uniform1i(uniform("encode"), state.converts_to_srgb() ? 0 : 1);
  const auto bind = [&](int unit, const GlTexture& texture) {
    gl->ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    gl->BindTexture(GL_TEXTURE_2D, texture.name());
  };
  bind(kVerticesUnit, picture(kScreenPicture));
  bind(kIndicesUnit, depth_picture ? picture(kNormalDepthPicture) : depth());
  state.use_host_output();
  gl->Enable(GL_SCISSOR_TEST);
  gl->Scissor(pixels[0], pixels[1], pixels[2], pixels[3]);
  gl->Viewport(host.viewport[0], host.viewport[1], host.viewport[2], host.viewport[3]);
  gl->Enablei(GL_BLEND, 0);
  gl->BlendEquationSeparate(GL_FUNC_ADD, GL_FUNC_ADD);
  gl->BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl->BindVertexArray(empty_array_.name());
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  return {};
}

Status Renderer::draw_into_host(Scene& scene, const HostView& host, const DrawOptions& options,
                                FrameStats* stats) {
  const auto start = std::chrono::steady_clock::now();
  auto view = view_rays(host.view, host.projection, host.viewport[2], host.viewport[3]);
  if (!view) return view.status();
  const DrawOptions own = for_a_host(options);
  const Status valid = check(own, scene.impl());
  if (!valid.ok()) return valid;
  const GlStateGuard state(*impl_->gl);
  Status status = impl_->draw_samples(scene.impl(), *view, own);
  if (status.ok()) status = impl_->composite(host, *view, scene.impl().box, own, state);
  if (status.ok() && stats) {
    *stats = impl_->stats(scene.impl());
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    stats->milliseconds = time.count();
  }
  return status;
}

Result<bool> Renderer::build_for(Scene& scene, const HostView& host, const DrawOptions& options,
                                 double milliseconds) {
  const auto view = view_rays(host.view, host.projection, host.viewport[2], host.viewport[3]);
  if (!view) return view.status();
  const DrawOptions own = for_a_host(options);
  const Status valid = check(own, scene.impl());
  if (!valid.ok()) return valid;
  const GlStateGuard state(*impl_->gl);
  const Status status = impl_->draw_samples_within(milliseconds, scene.impl(), *view, own);
  impl_->gl->Finish();  // what is not drawn yet would be waited for by the next frame
  if (status.code == StatusCode::cancelled) return false;
  return status.ok() ? Result<bool>(true) : Result<bool>(status);
}

Result<Frame> Renderer::read_host_view(Scene& scene, const HostView& host,
                                       const std::array<int, 4>& rectangle, const DrawOptions& options) {
  const auto whole = view_rays(host.view, host.projection, host.viewport[2], host.viewport[3]);
  if (!whole) return whole.status();
  if (rectangle[2] < 1 || rectangle[3] < 1)
    return {StatusCode::invalid_argument, "a rectangle needs at least one pixel"};
  const Status valid = check(options, scene.impl());
  if (!valid.ok()) return valid;
  const ViewRays view = part_of(*whole, rectangle);
  const GlStateGuard guard(*impl_->gl);
  // Pictures of their own: those of whole frames would be made anew for every pick.
  impl_->swap_targets();
  const Status status = impl_->draw_samples(scene.impl(), view, options);
  Frame frame;
  if (status.ok()) {
    frame.stats = impl_->stats(scene.impl());
    impl_->read_frame(scene.impl(), view, options, frame);
  }
  impl_->swap_targets();
  if (!status.ok()) return status;
  return frame;
}

}  // namespace dupin
