// The second half of a frame: once a pixel, from the primitive's number to colors and numbers.
//
// Only pixels that show something are worked on: the picture-covering triangle is drawn between the depth of
// an empty pixel, 0, and the least that anything drawn can have, and lets the depth test sort them out before
// the shader runs.
#include <limits>

#include "exact_pixels.h"
#include "layer.h"

namespace dupin {
namespace {

constexpr const char* kLocations[kPictures] = {"LOCATION_COLOR",        "LOCATION_COLOR",
                                               "LOCATION_NORMAL_DEPTH", "LOCATION_CURVATURE",
                                               "LOCATION_DIRECTION",    "LOCATION_NUMBERS"};

bool needs_curvature(Shading shading) {
  return shading == Shading::k1 || shading == Shading::k2 || shading == Shading::mean ||
         shading == Shading::gaussian;
}

/// In the picture of exact curvatures, where there are none: shaders/shade.frag's.
constexpr float kNoCurvature = 1e38F;

/// Curvatures of this size get three quarters of the way to the ends of the color scale.
double curvature_scale(const Scene::Impl& scene, const DrawOptions& options) {
  if (options.curvature_scale > 0) return options.curvature_scale;
  const double diagonal = scene.box.diagonal();
  return diagonal > 0 ? 10 / diagonal : 1;
}

}  // namespace

struct Variant {
  ProgramText text;
  std::string key;
  /// Adds a #define to the program and to the name that it is found by.
  void define(const std::string& what) {
    text.defines.push_back(what);
    key += ' ' + what;
  }
};

namespace {

/// A program that writes these pictures of what `surface` finds.
Variant shading_variant(unsigned pictures, const DrawOptions& options, const LayerShading& surface) {
  const bool color = pictures & (1U << kColorPicture | 1U << kScreenPicture),
             curves = pictures & 1U << kCurvaturePicture;
  const bool numbers = pictures & 1U << kNumbersPicture;
  Variant v;
  v.key = "shade " + surface.key;
  int location = 0;
  for (int i = 0; i < kPictures; ++i)
    if (pictures & 1U << i) v.define(std::string(kLocations[i]) + ' ' + std::to_string(location++));
  if (color) v.define("COLOR");
  if (color && wants_exact_colors(options)) v.define("EXACT_CURVATURES");
  if (color && !options.sections.empty()) v.define("CUT");
  if (color) v.define("SHADING " + std::to_string(static_cast<int>(options.shading)));
  if (color && !options.lights.empty()) v.define("LIGHTS " + std::to_string(options.lights.size()));
  if (pictures & 1U << kNormalDepthPicture) v.define("NORMAL_DEPTH");
  if (curves) v.define("CURVATURE");
  if (curves || (color && needs_curvature(options.shading))) v.define("CURVES");
  if (numbers || (color && options.shading == Shading::primitive)) v.define("NUMBERS");
  if (numbers) v.define("NUMBERS_PICTURE");
  for (const std::string& define : surface.defines) v.define(define);
  v.text.units = surface.units;
  v.text.vertex = {"screen.vert"};
  v.text.fragment = {"shade_head.glsl"};
  v.text.fragment.insert(v.text.fragment.end(), surface.surface.begin(), surface.surface.end());
  v.text.fragment.push_back("looks.glsl");
  v.text.fragment.push_back("lights.glsl");
  v.text.fragment.push_back("shade.frag");
  return v;
}

}  // namespace

Color premultiplied_background(const DrawOptions& options) {
  const Color c = options.background.value_or(Color{0, 0, 0, 0});
  return {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
}

std::uint32_t srgb_word(const Color& color) {
  const auto byte = [](float linear) {
    const float v = std::clamp(linear, 0.0F, 1.0F);
    return static_cast<std::uint32_t>(
        std::lround(255 * (v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F)));
  };
  return byte(color.r) | byte(color.g) << 8 | byte(color.b) << 16 | 0xff000000U;
}

Color linear_color(std::uint32_t word) {
  const auto linear = [](std::uint32_t byte) {
    const float s = static_cast<float>(byte & 255) / 255;
    return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F);
  };
  return {linear(word), linear(word >> 8), linear(word >> 16), 1};
}

Status Renderer::Impl::bind_shading_framebuffer(unsigned pictures) {
  gl->BindFramebuffer(GL_FRAMEBUFFER, shading_framebuffer_.name());
  std::vector<GLenum> buffers;
  for (int i = 0; i < kPictures; ++i) {
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    const bool wanted = pictures & 1U << i;
    const GlTexture& texture = pictures_[static_cast<std::size_t>(i)];
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, wanted ? texture.name() : 0, 0);
    if (wanted) buffers.push_back(attachment);
  }
  gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  gl->DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return {StatusCode::no_device, "this OpenGL context cannot draw into the pictures asked for"};
  gl->Viewport(0, 0, width_, height_);
  gl->BindVertexArray(empty_array_.name());
  return {};
}

void Renderer::Impl::clear_pictures(const Pass& pass) {
  GLint buffer = 0;
  for (int i = 0; i < kPictures; ++i) {
    if (!(pass.pictures & 1U << i)) continue;
    if (i == kNumbersPicture) {
      const GLuint none[4] = {0, 0, 0, 0};
      gl->ClearBufferuiv(GL_COLOR, buffer, none);
    } else {
      const Color c = premultiplied_background(*pass.options);
      const float n = static_cast<float>(pass.samples), infinity = std::numeric_limits<float>::infinity();
      const float color[4] = {n * c.r, n * c.g, n * c.b, n * c.a}, far[4] = {0, 0, 0, infinity},
                  zero[4] = {0, 0, 0, 0};
      gl->ClearBufferfv(GL_COLOR, buffer, i <= kColorPicture ? color : i == kNormalDepthPicture ? far : zero);
    }
    ++buffer;
  }
}

bool wants_exact_colors(const DrawOptions& options) {
  return options.exact_model && needs_curvature(options.shading);
}

/// Depths and numbers are shaded and read first; what is found comes back as a picture.
Status Renderer::Impl::find_exact_curvatures(const Pass& pass) {
  DrawOptions plain = *pass.options;
  plain.exact_model = nullptr;
  const Status status =
      shade({pass.scene, pass.view, &plain, 1U << kNormalDepthPicture | 1U << kNumbersPicture});
  if (!status.ok()) return status;
  std::vector<float> depth, curvatures;
  std::vector<std::uint32_t> numbers;
  read_numbers(depth, numbers);
  curvatures.assign(depth.size() * 2, kNoCurvature);
  find_exact(*pass.options->exact_model, *pass.scene, {pass.view, depth, numbers},
             {nullptr, &curvatures, nullptr});
  curvatures_ = GlTexture(*gl);
  gl->ActiveTexture(GL_TEXTURE0 + kCurvaturesUnit);
  gl->BindTexture(GL_TEXTURE_2D, curvatures_.name());
  gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, width_, height_, 0, GL_RG, GL_FLOAT, curvatures.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl->TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  return {};
}

Status Renderer::Impl::shade(const Pass& pass) {
  if (pass.exact_colors()) {
    const Status found = find_exact_curvatures(pass);
    if (!found.ok()) return found;
  }
  if (pass.at_once && pass.samples == 1 && pass.scene->layers.empty()) return {};
  Status status = bind_shading_framebuffer(pass.pictures);
  if (!status.ok()) return status;
  if (pass.pictures & 1U << kScreenPicture) gl->Enable(GL_FRAMEBUFFER_SRGB);
  gl->ActiveTexture(GL_TEXTURE0 + kIdsUnit);
  gl->BindTexture(GL_TEXTURE_2D, ids_.name());
  if (pass.first && !(pass.at_once && pass.samples == 1)) clear_pictures(pass);
  gl->Enable(GL_DEPTH_TEST);
  gl->DepthFunc(GL_LESS);
  gl->DepthMask(GL_FALSE);
  if (pass.samples > 1) {
    gl->Enablei(GL_BLEND, 0);
    gl->BlendEquationSeparate(GL_FUNC_ADD, GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
  }
  if (pass.at_once && pass.samples > 1) status = add_sample(pass);
  if (!pass.at_once) status = shade_dps(pass);
  if (!pass.at_once && status.ok()) status = shade_triangles(pass);
  if (status.ok())
    status =
        each_layer(pass, [&](Layer& layer, const LayerPass& own) { return shade_layer(pass, layer, own); });
  gl->Disablei(GL_BLEND, 0);
  gl->Disable(GL_FRAMEBUFFER_SRGB);
  return status;
}

Status Renderer::Impl::add_sample(const Pass& pass) {
  ProgramText text{{"screen.vert"}, {"add.frag"}, {}, {}, {{"colors", kVerticesUnit}}};
  const bool layers = !pass.scene->layers.empty();
  if (layers) text.defines.push_back("LAYERS");
  const auto name = program(layers ? "add beside layers" : "add", text);
  if (!name) return name.status();
  set_view(*name, pass.view);
  set_looks(*name, pass);
  gl->ActiveTexture(GL_TEXTURE0 + kVerticesUnit);
  gl->BindTexture(GL_TEXTURE_2D, sample_.name());
  cover_bands(*name);
  return {};
}

Status Renderer::Impl::resolve(const ViewRays& view, int samples) {
  const auto name =
      program("resolve", {{"screen.vert"}, {"resolve.frag"}, {}, {}, {{"colors", kVerticesUnit}}});
  if (!name) return name.status();
  set_view(*name, view);
  gl->Uniform1f(gl->GetUniformLocation(*name, "samples"), static_cast<float>(samples));
  const Status status = bind_shading_framebuffer(1U << kScreenPicture);
  if (!status.ok()) return status;
  gl->Enable(GL_FRAMEBUFFER_SRGB);
  gl->Disable(GL_DEPTH_TEST);
  gl->ActiveTexture(GL_TEXTURE0 + kVerticesUnit);
  gl->BindTexture(GL_TEXTURE_2D, pictures_[kColorPicture].name());
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  gl->Disable(GL_FRAMEBUFFER_SRGB);
  return {};
}

void Renderer::Impl::set_looks(GLuint name, const Pass& pass) const {
  const DrawOptions& options = *pass.options;
  const auto uniform = [&](const char* n) { return gl->GetUniformLocation(name, n); };
  const Color under = pass.samples > 1 ? premultiplied_background(options) : Color{0, 0, 0, 0};
  gl->Uniform4f(uniform("under"), under.r, under.g, under.b, under.a);
  gl->Uniform1f(uniform("curvature_scale"), static_cast<float>(curvature_scale(*pass.scene, options)));
  for (std::size_t i = 0; i < options.lights.size(); ++i) {
    const std::string element = "[" + std::to_string(i) + "]";
    const Vec3 d = options.lights[i].position - pass.view.eye;
    const Color& c = options.lights[i].color;
    gl->Uniform3f(uniform(("lights" + element).c_str()), static_cast<float>(dot(d, pass.view.right)),
                  static_cast<float>(dot(d, pass.view.up)), static_cast<float>(-dot(d, pass.view.forward)));
    gl->Uniform3f(uniform(("light_colors" + element).c_str()), c.r, c.g, c.b);
  }
  gl->Uniform1ui(uniform("only_color"), options.color ? srgb_word(*options.color) : 0);
}

/// Leaves the program in use, with what all of them share set.
Status Renderer::Impl::use_shading_program(const Pass& pass, const Variant& variant, GLuint& name) {
  const auto built = program(variant.key, variant.text);
  if (!built) return built.status();
  name = *built;
  set_view(name, pass.view);
  set_looks(name, pass);
  return {};
}

void Renderer::Impl::cover_bands(GLuint name) {
  gl->Uniform1f(gl->GetUniformLocation(name, "screen_depth"), list_.covered_depth());
  gl->Enable(GL_SCISSOR_TEST);
  for (std::size_t b = 0; b < list_.bands.size(); ++b) {
    const auto [first, last] = list_.bands[b];
    if (first >= last) continue;
    gl->Scissor(first, static_cast<GLint>(b) * kBandRows, last - first, kBandRows);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl->Disable(GL_SCISSOR_TEST);
}

Status Renderer::Impl::shade_dps(const Pass& pass) {
  if (list_.items.empty()) return {};
  static const LayerShading kSurface{"", {"quadric.glsl", "curvatures.glsl", "surface_dp.glsl"}, {}, {}};
  GLuint name = 0;
  const Status status =
      use_shading_program(pass, shading_variant(pass.pictures, *pass.options, kSurface), name);
  if (status.ok()) cover_bands(name);
  return status;
}

Status Renderer::Impl::shade_triangles(const Pass& pass) {
  if (list_.runs.empty()) return {};
  // Triangles need no heap.
  static const LayerShading kSurface{"mesh", {"runs.glsl", "surface_mesh.glsl"}, {}, {{"colors", kHeapUnit}}};
  GLuint name = 0;
  const Status status =
      use_shading_program(pass, shading_variant(pass.pictures, *pass.options, kSurface), name);
  if (!status.ok()) return status;
  gl->Uniform1i(gl->GetUniformLocation(name, "run_count"), static_cast<GLint>(list_.runs.size()));
  pass.scene->vertices.bind(kVerticesUnit);
  pass.scene->indices.bind(kIndicesUnit);
  pass.scene->triangle_faces.bind(kTriangleFacesUnit);
  pass.scene->colors.bind(kHeapUnit);
  runs_.bind(kRunsUnit);
  cover_bands(name);
  return {};
}

Status Renderer::Impl::shade_layer(const Pass& pass, Layer& layer, const LayerPass& own) {
  if (layer.drawn() == 0) return {};
  LayerShading surface = layer.shading();
  surface.surface.insert(surface.surface.begin(), "layer.glsl");
  surface.defines.push_back(layer_define(own.layer));
  GLuint name = 0;
  const Status status =
      use_shading_program(pass, shading_variant(pass.pictures, *pass.options, surface), name);
  if (!status.ok()) return status;
  layer.bind(own, name);
  cover_bands(name);
  return {};
}

}  // namespace dupin
