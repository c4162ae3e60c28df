#include "domain_painter.h"

namespace dupin {
namespace {

/// Less of a domain than this (8 bits of Ψ) adds nothing, and what is not above the threshold of domains
/// locks nothing.
constexpr float kLeastBlended = 0.5F / 255, kLeastLocking = static_cast<float>(kDomainThreshold);

GlTexture sum_texture(const Gl& gl, int width, int height) {
  GlTexture texture(gl);
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  return texture;
}

void keep_sums(const Gl& gl, bool sums) {
  const GLboolean yes = sums ? GL_TRUE : GL_FALSE, no = sums ? GL_FALSE : GL_TRUE;
  gl.DepthMask(no);
  gl.ColorMaski(0, no, no, no, no);
  for (const GLuint i : {1U, 2U}) gl.ColorMaski(i, yes, yes, yes, yes);
}

}  // namespace

void DomainPainter::clear() {
  domains_.clear();
  entries_.clear();
}

void DomainPainter::add(const DomainPackage& package, const PlacedSet& set, std::uint32_t instance,
                        std::uint32_t number, const PartCamera& camera, double scale) {
  const auto first = static_cast<std::uint32_t>(domains_.size());
  for (std::uint32_t i = 0; i < set.count; ++i) {
    const PlacedDomain& placed = package.domains[set.first + i];
    PrefixDomain domain;
    const Vec3 to_viewer = camera.perspective ? camera.eye - placed.center : camera.eye;
    domain.distance =
        camera.perspective ? scale * length(to_viewer) : dot(camera.depth.n, placed.center) + camera.depth.d;
    domain.facing = !placed.oriented || dot(to_viewer, placed.normal) > 0;
    for (std::uint32_t k = 0; k < placed.neighbors; ++k)
      domain.neighbors.push_back(first + package.neighbors[placed.first_neighbor + k] - set.first);
    domains_.push_back(std::move(domain));
    entries_.push_back({number + i, instance, set.first + i, placed.oriented});
  }
}

Status DomainPainter::prepare(const LayerPass& pass) {
  const Gl& gl = *pass.renderer.gl;
  if (pass.view.width != width_ || pass.view.height != height_) {
    width_ = pass.view.width;
    height_ = pass.view.height;
    normal_ = sum_texture(gl, width_, height_);
    color_ = sum_texture(gl, width_, height_);
  }
  if (!framebuffer_) framebuffer_ = GlFramebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  const auto attach = [&](GLenum where, const GlTexture& texture) {
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, where, GL_TEXTURE_2D, texture.name(), 0);
  };
  attach(GL_COLOR_ATTACHMENT0, pass.renderer.ids());
  attach(GL_COLOR_ATTACHMENT1, normal_);
  attach(GL_COLOR_ATTACHMENT2, color_);
  attach(GL_DEPTH_ATTACHMENT, pass.renderer.depth());
  constexpr GLenum kBuffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  gl.DrawBuffers(3, kBuffers);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return {StatusCode::no_device, "this OpenGL context cannot blend domains"};
  return {};
}

Status DomainPainter::draw(const LayerPass& pass, GLuint program, int order_unit) {
  const Gl& gl = *pass.renderer.gl;
  if (Status ready = prepare(pass); !ready.ok()) return ready;
  const PrefixPlan plan = plan_prefixes(domains_);
  std::vector<Entry> order;
  for (const std::uint32_t i : plan.order) order.push_back(entries_[i]);
  if (!order_.buffer()) order_ = TexelBuffer(gl, GL_RGBA32UI);
  order_.assign(order.data(), order.size() * sizeof(Entry), GL_STREAM_DRAW);
  order_.bind(order_unit);
  const GLfloat nothing[4] = {0, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 1, nothing);
  gl.ClearBufferfv(GL_COLOR, 2, nothing);
  gl.Enablei(GL_BLEND, 1);
  gl.Enablei(GL_BLEND, 2);
  gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
  const GLint least = gl.GetUniformLocation(program, "least_psi");
  const auto rectangles = [&](std::uint32_t first, std::uint32_t count) {
    gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(6 * first), static_cast<GLsizei>(6 * count));
  };
  for (const PrefixStep& step : plan.steps) {
    if (step.count > 0) {
      keep_sums(gl, true);
      gl.Uniform1f(least, kLeastBlended);
      rectangles(step.first, step.count);
    }
    keep_sums(gl, false);
    gl.Uniform1f(least, kLeastLocking);
    rectangles(step.lock, 1);
  }
  gl.Disablei(GL_BLEND, 1);
  gl.Disablei(GL_BLEND, 2);
  gl.DepthMask(GL_TRUE);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  // Ids and depth belong to the renderer, which may replace them.
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, 0, 0);
  return {};
}

void DomainPainter::bind(const Gl& gl, int normal_unit, int color_unit) const {
  for (const auto& [unit, texture] : {std::pair{normal_unit, &normal_}, {color_unit, &color_}}) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(GL_TEXTURE_2D, texture->name());
  }
}

}  // namespace dupin
