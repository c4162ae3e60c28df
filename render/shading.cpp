// The second half of a frame: once a pixel, from the primitive's number to colors and numbers.
#include <bit>

#include "renderer_impl.h"

namespace dupin {
namespace {

struct PictureFormat {
  GLenum internal, format, type;
};
constexpr PictureFormat kFormats[kPictures] = {{GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RG32F, GL_RG, GL_FLOAT},
                                               {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT}};
constexpr const char* kLocations[kPictures] = {"LOCATION_COLOR", "LOCATION_NORMAL_DEPTH",
                                               "LOCATION_CURVATURE", "LOCATION_DIRECTION",
                                               "LOCATION_NUMBERS"};

void allocate(const Gl& gl, GlTexture& texture, const PictureFormat& format, int width, int height) {
  texture = GlTexture(gl);
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internal), width, height, 0, format.format,
                format.type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
}

bool needs_curvature(Shading shading) {
  return shading == Shading::k1 || shading == Shading::k2 || shading == Shading::mean ||
         shading == Shading::gaussian;
}

/// Curvatures of this size get three quarters of the way to the ends of the color scale.
double curvature_scale(const Scene::Impl& scene, const DrawOptions& options) {
  if (options.curvature_scale > 0) return options.curvature_scale;
  const double diagonal = scene.box.diagonal();
  return diagonal > 0 ? 10 / diagonal : 1;
}

std::uint32_t srgb_word(const Color& c) {
  const auto byte = [](float linear) {
    const float v = std::clamp(linear, 0.0F, 1.0F);
    return static_cast<std::uint32_t>(
        std::lround(255 * (v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F)));
  };
  return byte(c.r) | byte(c.g) << 8 | byte(c.b) << 16 | 0xff000000U;
}

}  // namespace

unsigned pictures_for(unsigned outputs) {
  unsigned pictures = 0;
  if (outputs & kColor) pictures |= 1U << kColorPicture;
  if (outputs & (kNormal | kDepth | kPosition | kUv)) pictures |= 1U << kNormalDepthPicture;
  if (outputs & (kCurvature | kDirection)) pictures |= 1U << kCurvaturePicture | 1U << kDirectionPicture;
  if (outputs & (kFace | kPrimitive | kUv)) pictures |= 1U << kNumbersPicture;
  return pictures;
}

Status Renderer::Impl::prepare_targets(int width, int height, unsigned pictures) {
  if (width < 1 || height < 1) return {StatusCode::invalid_argument, "a picture needs at least one pixel"};
  if (width > max_picture || height > max_picture)
    return {StatusCode::limit, "the picture is larger than " + std::to_string(max_picture) +
                                   " pixels, this OpenGL context's limit"};
  if (width != width_ || height != height_) {
    for (GlTexture& picture : pictures_) picture = {};
    allocate(*gl, ids_, {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT}, width, height);
    allocate(*gl, depth_, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, width, height);
    gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.name());
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, ids_.name(), 0);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    width_ = width;
    height_ = height;
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return {StatusCode::no_device, "this OpenGL context cannot draw numbers with a float depth buffer"};
  }
  for (int i = 0; i < kPictures; ++i) {
    GlTexture& picture = pictures_[static_cast<std::size_t>(i)];
    if ((pictures & 1U << i) && !picture) allocate(*gl, picture, kFormats[i], width, height);
  }
  return {};
}

Status Renderer::Impl::shade(const Pass& pass) {
  gl->BindFramebuffer(GL_FRAMEBUFFER, shading_framebuffer_.name());
  std::vector<GLenum> buffers;
  for (int i = 0; i < kPictures; ++i) {
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    const bool wanted = pass.pictures & 1U << i;
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D,
                             wanted ? pictures_[static_cast<std::size_t>(i)].name() : 0, 0);
    if (wanted) buffers.push_back(attachment);
  }
  gl->DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return {StatusCode::no_device, "this OpenGL context cannot draw into float pictures"};
  gl->Viewport(0, 0, width_, height_);
  gl->Disable(GL_DEPTH_TEST);
  gl->DepthMask(GL_FALSE);
  if (pass.accumulate) {
    gl->Enablei(GL_BLEND, 0);
    gl->BlendEquationSeparate(GL_FUNC_ADD, GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
  }
  gl->ActiveTexture(GL_TEXTURE0 + kIdsUnit);
  gl->BindTexture(GL_TEXTURE_2D, ids_.name());
  const bool mesh = !list_.runs.empty(), dps = !list_.items.empty() || !mesh;
  Status status;
  if (dps) status = shade_with(pass, false, false);
  if (status.ok() && mesh) status = shade_with(pass, true, dps);
  gl->Disablei(GL_BLEND, 0);
  return status;
}

Status Renderer::Impl::shade_with(const Pass& pass, bool mesh, bool second) {
  const DrawOptions& options = *pass.options;
  const bool color = pass.pictures & 1U << kColorPicture, curves = pass.pictures & 1U << kCurvaturePicture;
  ProgramText text;
  std::string key = "shade";
  const auto define = [&](const std::string& what) {
    text.defines.push_back(what);
    key += ' ' + what;
  };
  int location = 0;
  for (int i = 0; i < kPictures; ++i)
    if (pass.pictures & 1U << i) define(std::string(kLocations[i]) + ' ' + std::to_string(location++));
  if (color) define("COLOR");
  if (color) define("SHADING " + std::to_string(static_cast<int>(options.shading)));
  if (pass.pictures & 1U << kNormalDepthPicture) define("NORMAL_DEPTH");
  if (curves) define("CURVATURE");
  if (curves || (color && needs_curvature(options.shading))) define("CURVES");
  if ((pass.pictures & 1U << kNumbersPicture) || (color && options.shading == Shading::primitive))
    define("NUMBERS");
  if (pass.pictures & 1U << kNumbersPicture) define("NUMBERS_PICTURE");
  if (color && options.edges) define("EDGES");
  if (second) define("SECOND_PASS");
  text.vertex = {"screen.vert"};
  text.fragment = {"shade_head.glsl", "quadric.glsl"};
  if (mesh) {
    key += " mesh";
    text.fragment.push_back("surface_mesh.glsl");
    text.units.push_back({"colors", kHeapUnit});  // triangles need no heap
  } else {
    text.fragment.push_back("edges.glsl");
    text.fragment.push_back("surface_dp.glsl");
  }
  text.fragment.push_back("looks.glsl");
  text.fragment.push_back("shade.frag");
  const auto name = program(key, text);
  if (!name) return name.status();
  set_view(*name, pass.view);
  const auto uniform = [&](const char* n) { return gl->GetUniformLocation(*name, n); };
  const Color background = options.background.value_or(Color{0, 0, 0, 0});
  gl->Uniform4f(uniform("background"), background.r * background.a, background.g * background.a,
                background.b * background.a, background.a);
  gl->Uniform1f(uniform("edge_half_width"), static_cast<float>(options.edge_width_px / 2));
  gl->Uniform1f(uniform("curvature_scale"), static_cast<float>(curvature_scale(*pass.scene, options)));
  gl->Uniform1ui(uniform("only_color"), options.color ? srgb_word(*options.color) : 0);
  gl->Uniform1i(uniform("run_count"), static_cast<GLint>(list_.runs.size()));
  if (mesh) {
    pass.scene->vertices.bind(kVerticesUnit);
    pass.scene->indices.bind(kIndicesUnit);
    pass.scene->triangle_faces.bind(kTriangleFacesUnit);
    pass.scene->colors.bind(kHeapUnit);
    runs_.bind(kRunsUnit);
  }
  gl->BindVertexArray(empty_array_.name());
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  return {};
}

void Renderer::Impl::read(Picture picture, GLenum format, GLenum type, void* pixels) {
  gl->BindFramebuffer(GL_FRAMEBUFFER, shading_framebuffer_.name());
  gl->ReadBuffer(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + picture));
  gl->ReadPixels(0, 0, width_, height_, format, type, pixels);
}

void Renderer::Impl::read_ids(std::uint32_t* pixels) {
  gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.name());
  gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl->ReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels);
}

}  // namespace dupin
