#include "renderer.h"

#include <chrono>

#include "../core/parallel.h"
#include "gl_state.h"
#include "layer.h"

namespace dupin {
namespace {

constexpr int kMostHalfSamples = 16;

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Where in a pixel its samples lie: four on a turned grid; otherwise the additive sequence of the plastic
/// number, which is even in the plane.
Vec2 sample_offset(int index, int count) {
  if (count == 1) return {};
  if (count == 4) {
    constexpr Vec2 kTurned[] = {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}};
    return kTurned[index];
  }
  constexpr double kPlastic = 1.32471795724474602596;
  const double u = std::fmod((index + 1) / kPlastic, 1),
               v = std::fmod((index + 1) / (kPlastic * kPlastic), 1);
  return {u - 0.5, v - 0.5};
}

/// Colors that need no more of a surface than its normal and numbers.
bool drawn_at_once(Shading shading, bool highlights) {
  return shading == Shading::lit || (shading == Shading::zebra && !highlights) || shading == Shading::face ||
         shading == Shading::primitive;
}

std::string text_of(const Gl& gl, GLenum what) {
  const auto* text = reinterpret_cast<const char*>(gl.GetString(what));
  return text ? text : "";
}

}  // namespace

Status check(const DrawOptions& options) {
  if (options.samples < 1 || options.samples > 256)
    return {StatusCode::invalid_argument, "a pixel can have 1 to 256 samples"};
  if (options.sections.size() > kMostSections)
    return {StatusCode::invalid_argument,
            "a model can be cut by " + std::to_string(kMostSections) + " sections"};
  for (const DrawOptions::Section& section : options.sections)
    if (const double l = length(section.normal);
        !(l > 0 && std::isfinite(l) && std::isfinite(section.offset)))
      return {StatusCode::invalid_argument, "a section needs a direction and a finite offset"};
  if ((options.outputs & kUv) && !options.exact_model)
    return {StatusCode::invalid_argument, "parameters need the model"};
  if (options.lights.size() > kMostLights)
    return {StatusCode::invalid_argument, "a frame can have " + std::to_string(kMostLights) + " lights"};
  return {};
}

Status check(const DrawOptions& options, const Scene::Impl& scene) {
  if (options.exact_model && (options.exact_model->parts.size() != scene.parts.size() ||
                              options.exact_model->instances.size() != scene.instances.size()))
    return {StatusCode::invalid_argument, "the model is not the one that the scene was made from"};
  return check(options);
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;
std::string Renderer::gl_renderer() const {
  return impl_->gl_renderer;
}
std::string Renderer::gl_version() const {
  return impl_->gl_version;
}

Status Renderer::Impl::init(const GetProcAddress& get_proc_address) {
  auto loaded = load_gl(get_proc_address);
  if (!loaded) return loaded.status();
  gl = std::make_shared<const Gl>(*loaded);
  const GlStateGuard guard(*gl);
  gl_renderer = text_of(*gl, GL_RENDERER);
  gl_version = text_of(*gl, GL_VERSION);
  gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_texels);
  gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &max_picture);
  GLint components = 0;
  gl->GetIntegerv(GL_MAX_VARYING_COMPONENTS, &components);
  flats_ = components >= kFlatComponents;
  at_once_ = components >= kAtOnceComponents;
  instances_ = TexelBuffer(*gl, GL_RGBA32F);
  slots_ = TexelBuffer(*gl, GL_RGBA32UI);
  runs_ = TexelBuffer(*gl, GL_RGBA32UI);
  tiles_ = TexelBuffer(*gl, GL_RGBA32UI);
  for (GlBuffer* buffer : {&items_, &quads_, &prisms_}) *buffer = GlBuffer(*gl);
  for (GlVertexArray* array : {&item_array_, &quad_array_, &prism_array_, &empty_array_})
    *array = GlVertexArray(*gl);
  visibility_framebuffer_ = GlFramebuffer(*gl);
  other_.visibility_framebuffer = GlFramebuffer(*gl);
  shading_framebuffer_ = GlFramebuffer(*gl);
  gl->BindVertexArray(item_array_.name());
  gl->BindBuffer(GL_ARRAY_BUFFER, items_.name());
  gl->EnableVertexAttribArray(0);
  gl->VertexAttribIPointer(0, 4, GL_UNSIGNED_INT, sizeof(DrawItem), nullptr);
  return {};
}

Result<std::unique_ptr<Renderer>> Renderer::create(const GetProcAddress& get_proc_address) {
  auto impl = std::make_unique<Impl>();
  const Status status = impl->init(get_proc_address);
  if (!status.ok()) return status;
  return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

Result<std::unique_ptr<Scene>> Renderer::upload(const Model& model, const SceneContent& content) {
  auto scene = std::make_unique<Scene::Impl>();
  auto layers = make_layers(model, content);
  if (!layers) return layers.status();
  scene->layers = std::move(*layers);
  ScenePackage package;
  Status status = pack_scene(model, content.dps, *scene, package);
  if (!status.ok()) return status;
  const Gl& gl = *impl_->gl;
  const GlStateGuard guard(gl);
  scene->gl = impl_->gl;
  if (std::max({package.heap.size(), package.vertices.size() / 2, package.indices.size()}) >
      static_cast<std::size_t>(impl_->max_texels))
    return {StatusCode::limit, "the model is larger than this OpenGL context's texture buffers can hold"};
  const auto fill = [&](TexelBuffer& buffer, GLenum format, const auto& content) {
    buffer = TexelBuffer(gl, format);
    buffer.assign(content.data(), content.size() * sizeof(content[0]), GL_STATIC_DRAW);
  };
  fill(scene->heap, GL_RGBA32UI, package.heap);
  if (!package.indices.empty() || !scene->layers.empty()) fill(scene->colors, GL_R32UI, scene->color_words());
  if (!package.indices.empty()) {
    fill(scene->vertices, GL_RG32F, package.vertices);
    fill(scene->indices, GL_R32UI, package.indices);
    fill(scene->triangle_faces, GL_R32UI, package.triangle_faces);
    scene->mesh_array = GlVertexArray(gl);
    gl.BindVertexArray(scene->mesh_array.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, scene->vertices.buffer());
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 24, nullptr);
    gl.EnableVertexAttribArray(1);
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, reinterpret_cast<const void*>(std::size_t{12}));
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, scene->indices.buffer());
  }
  for (std::uint32_t i = 0; i < scene->layers.size() && status.ok(); ++i)
    status = scene->layers[i]->upload(*impl_, *scene, i);
  if (!status.ok()) return status;
  gl.Finish();
  return std::make_unique<Scene>(std::move(scene));
}

/// Every sample's passes, the color picture holding their sum; a single sample goes to the screen picture at
/// once where it can.
Status Renderer::Impl::draw_samples(const Scene::Impl& scene, const ViewRays& view,
                                    const DrawOptions& options) {
  const bool floats = options.outputs & kColor, screen = options.outputs & kScreen;
  const float alpha = options.background ? options.background->a : 0;
  const bool straight = screen && !floats && options.samples == 1 && (alpha == 0 || alpha == 1);
  const unsigned others = pictures_for(options.outputs & ~(kColor | kScreen));
  const unsigned color = straight ? 1U << kScreenPicture : floats || screen ? 1U << kColorPicture : 0U;
  // Half floats hold the sum of a few samples as well as 8 bits can show it.
  const GLenum format = floats || options.samples > kMostHalfSamples ? GL_RGBA32F : GL_RGBA16F;
  const unsigned exact =
      color && wants_exact_colors(options) ? 1U << kNormalDepthPicture | 1U << kNumbersPicture : 0U;
  Status status = prepare_targets(view.width, view.height,
                                  others | color | exact | (screen ? 1U << kScreenPicture : 0U), format);
  const bool together = options.samples == 1 || !color;
  const bool at_once = at_once_ && screen && !floats && drawn_at_once(options.shading, scene.highlights) &&
                       options.lights.empty() && options.sections.empty();
  if (at_once && status.ok() && !together) prepare_sample(view.width, view.height);
  for (int i = 0; i < options.samples && status.ok() && !together; ++i) {
    const Vec2 offset = sample_offset(i, options.samples);
    status = run({&scene, jittered(view, offset.x, offset.y), &options, color, options.samples, i == 0,
                  at_once ? &sample_ : nullptr});
  }
  // The other pictures, and the numbers of what is seen, are the pixel centres'.
  if (status.ok() && (together || others))
    status = run({&scene, view, &options, together ? others | color : others, 1, true,
                  at_once && straight && !others ? &pictures_[kScreenPicture] : nullptr});
  return status.ok() && screen && !straight ? resolve(view, options.samples) : status;
}

Result<FrameStats> Renderer::draw_only(Scene& scene, const Camera& camera, const DrawOptions& options) {
  const Status valid = check(options, scene.impl());
  if (!valid.ok()) return valid;
  const GlStateGuard guard(*impl_->gl);
  const auto start = Clock::now();
  const Status status = impl_->draw_samples(scene.impl(), view_rays(camera), options);
  if (!status.ok()) return status;
  impl_->gl->Finish();
  FrameStats stats = impl_->stats(scene.impl());
  stats.milliseconds = milliseconds_since(start);
  return stats;
}

Result<Frame> Renderer::draw(Scene& scene, const Camera& camera, const DrawOptions& options) {
  const Status valid = check(options, scene.impl());
  if (!valid.ok()) return valid;
  const GlStateGuard guard(*impl_->gl);
  const auto start = Clock::now();
  const ViewRays view = view_rays(camera);
  const Status status = impl_->draw_samples(scene.impl(), view, options);
  if (!status.ok()) return status;
  impl_->gl->Finish();
  Frame frame;
  frame.stats = impl_->stats(scene.impl());
  frame.stats.milliseconds = milliseconds_since(start);
  impl_->read_frame(scene.impl(), view, options, frame);
  return frame;
}

}  // namespace dupin
