// Building programs on first use, and the uniforms that all of them share.
#include <algorithm>

#include "part_camera.h"
#include "renderer_impl.h"

namespace dupin {

Status Renderer::Impl::may_build() {
  if (!build_time_) return {};
  const auto now = std::chrono::steady_clock::now();
  if (!build_until_)
    build_until_ = now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(*build_time_);
  else if (now >= *build_until_)
    return {StatusCode::cancelled, "there are more programs to build"};
  return {};
}

Status Renderer::Impl::draw_samples_within(double milliseconds, const Scene::Impl& scene,
                                           const ViewRays& view, const DrawOptions& options) {
  build_time_ = std::chrono::duration<double, std::milli>(milliseconds);
  build_until_.reset();
  const Status status = draw_samples(scene, view, options);
  build_time_.reset();
  return status;
}

Result<GLuint> Renderer::Impl::program(const std::string& wanted, const ProgramText& text) {
  // Whatever draws proxies is cut by the sections.
  const bool cut = !sections_.empty() && !text.vertex.empty() &&
                   std::find(text.vertex.begin(), text.vertex.end(), "proxy.glsl") != text.vertex.end();
  const std::string number = std::to_string(sections_.size());
  const std::string key = cut ? wanted + " cut " + number : wanted;
  const auto found = programs_.find(key);
  if (found != programs_.end()) {
    gl->UseProgram(found->second.name());
    return found->second.name();
  }
  if (const Status status = may_build(); !status.ok()) return status;
  ProgramText full = text;
  if (cut) full.defines.push_back("SECTIONS " + number);
  full.units = {{"heap", kHeapUnit},
                {"instances", kInstancesUnit},
                {"slots", kSlotsUnit},
                {"ids", kIdsUnit},
                {"curvatures", kCurvaturesUnit},
                {"vertices", kVerticesUnit},
                {"indices", kIndicesUnit},
                {"runs", kRunsUnit},
                {"tiles", kTilesUnit},
                {"triangle_faces", kTriangleFacesUnit}};
  for (const auto& unit : text.units) full.units.push_back(unit);
  auto built = build_program(*gl, full);
  if (!built) return built.status();
  const GLuint name = built->name();
  programs_.emplace(key, std::move(*built));
  return name;
}

void Renderer::Impl::set_view(GLuint name, const ViewRays& view) const {
  const auto location = [&](const char* uniform) { return gl->GetUniformLocation(name, uniform); };
  const auto set = [&](const char* uniform, double value) {
    gl->Uniform1f(location(uniform), static_cast<float>(value));
  };
  set("start", view.perspective ? list_.start_depth : 1);
  set("spread", view.perspective ? 1 : 0);
  set("start_depth", list_.start_depth);
  set("near_depth", list_.near_depth);
  set("zero_to_one", gl->ClipControl ? 1 : 0);
  gl->Uniform2f(location("picture"), static_cast<float>(view.width), static_cast<float>(view.height));
  gl->Uniform2f(location("pixel"), static_cast<float>(2.0 / view.width),
                static_cast<float>(2.0 / view.height));
  const auto& terms = list_.depth_terms;
  gl->Uniform3f(location("depth_terms"), static_cast<float>(terms[0]), static_cast<float>(terms[1]),
                static_cast<float>(terms[2]));
  gl->Uniform2f(location("axis_scale"), static_cast<float>(1 / view.sx), static_cast<float>(1 / view.sy));
  gl->Uniform2f(location("ray_scale"), static_cast<float>(view.sx), static_cast<float>(view.sy));
  gl->Uniform2f(location("axis_offset"), static_cast<float>(view.ox), static_cast<float>(view.oy));
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const auto value = section_terms(sections_[i], view);
    const auto term = [&](std::size_t k) { return static_cast<float>(value[k]); };
    gl->Uniform4f(location(("sections[" + std::to_string(i) + "]").c_str()), term(0), term(1), term(2),
                  term(3));
  }
  const Vec3 back = -view.forward;
  const float axes[9] = {
      static_cast<float>(view.right.x), static_cast<float>(view.right.y), static_cast<float>(view.right.z),
      static_cast<float>(view.up.x),    static_cast<float>(view.up.y),    static_cast<float>(view.up.z),
      static_cast<float>(back.x),       static_cast<float>(back.y),       static_cast<float>(back.z)};
  gl->UniformMatrix3fv(location("to_model"), 1, GL_FALSE, axes);
}

}  // namespace dupin
