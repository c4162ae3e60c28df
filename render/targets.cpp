// The pictures that a frame is drawn into.
#include "renderer_impl.h"

namespace dupin {
namespace {

struct PictureFormat {
  GLenum internal, format, type;
};
constexpr PictureFormat kFormats[kPictures] = {{GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE},
                                               {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RG32F, GL_RG, GL_FLOAT},
                                               {GL_RGBA32F, GL_RGBA, GL_FLOAT},
                                               {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT}};

void allocate(const Gl& gl, GlTexture& texture, const PictureFormat& format, int width, int height) {
  texture = GlTexture(gl);
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internal), width, height, 0, format.format,
                format.type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
}

}  // namespace

unsigned pictures_for(unsigned outputs) {
  unsigned pictures = 0;
  if (outputs & kScreen) pictures |= 1U << kScreenPicture;
  if (outputs & kColor) pictures |= 1U << kColorPicture;
  // What is told from the exact surface starts from depths and numbers.
  constexpr unsigned kFromExact = kUv | kCurvature | kDirection;
  if (outputs & (kNormal | kDepth | kPosition | kFromExact)) pictures |= 1U << kNormalDepthPicture;
  if (outputs & (kCurvature | kDirection)) pictures |= 1U << kCurvaturePicture | 1U << kDirectionPicture;
  if (outputs & (kFace | kPrimitive | kFromExact)) pictures |= 1U << kNumbersPicture;
  return pictures;
}

Status Renderer::Impl::prepare_targets(int width, int height, unsigned pictures, GLenum color_format) {
  if (width < 1 || height < 1) return {StatusCode::invalid_argument, "a picture needs at least one pixel"};
  if (width > max_picture || height > max_picture)
    return {StatusCode::limit, "the picture is larger than " + std::to_string(max_picture) +
                                   " pixels, this OpenGL context's limit"};
  if (width != width_ || height != height_) {
    for (GlTexture& picture : pictures_) picture = {};
    sample_ = {};
    curvatures_ = {};
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
  if (color_format != color_format_) pictures_[kColorPicture] = {};
  color_format_ = color_format;
  for (int i = 0; i < kPictures; ++i) {
    PictureFormat format = kFormats[i];
    if (i == kColorPicture) format.internal = color_format;
    GlTexture& picture = pictures_[static_cast<std::size_t>(i)];
    if ((pictures & 1U << i) && !picture) allocate(*gl, picture, format, width, height);
  }
  return {};
}

void Renderer::Impl::swap_targets() {
  std::swap(width_, other_.width);
  std::swap(height_, other_.height);
  std::swap(ids_, other_.ids);
  std::swap(depth_, other_.depth);
  std::swap(sample_, other_.sample);
  std::swap(curvatures_, other_.curvatures);
  std::swap(color_format_, other_.color_format);
  std::swap(pictures_, other_.pictures);
  std::swap(visibility_framebuffer_, other_.visibility_framebuffer);
}

void Renderer::Impl::prepare_sample(int width, int height) {
  if (!sample_) allocate(*gl, sample_, kFormats[kScreenPicture], width, height);
}

void Renderer::Impl::read(Picture picture, GLenum format, GLenum type, void* pixels) {
  bind_shading_framebuffer(1U << picture);
  gl->ReadBuffer(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + picture));
  gl->ReadPixels(0, 0, width_, height_, format, type, pixels);
}

void Renderer::Impl::read_ids(std::uint32_t* pixels) {
  gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.name());
  gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl->ReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels);
}

}  // namespace dupin
