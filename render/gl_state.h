// Everything of a context's state that drawing here touches, taken on construction and put back on
// destruction.
#ifndef DUPIN_RENDER_GL_STATE_H
#define DUPIN_RENDER_GL_STATE_H

#include <array>
#include <optional>
#include <vector>

#include "gl_fixed_function.h"
#include "gl_objects.h"

namespace dupin {

class GlStateGuard {
 public:
  /// Takes the state and puts in place what drawing expects: no scissor, blending, culling, sRGB conversion,
  /// …
  explicit GlStateGuard(const Gl& gl);
  ~GlStateGuard();
  GlStateGuard(const GlStateGuard&) = delete;
  GlStateGuard& operator=(const GlStateGuard&) = delete;

  /// Of the host's, as they were.
  GLuint draw_framebuffer() const { return static_cast<GLuint>(draw_framebuffer_); }
  std::array<double, 2> depth_range() const { return depth_range_; }
  bool clip_zero_to_one() const { return clip_depth_ == GL_ZERO_TO_ONE; }
  /// Whether what is written to the host's first color buffer is converted from linear light.
  bool converts_to_srgb() const;
  /// x, y, width, height; none: everywhere.
  std::optional<std::array<GLint, 4>> scissor() const {
    return enabled_[kScissor] ? std::optional(scissor_) : std::nullopt;
  }
  /// Depth test, scissor, color mask and sRGB conversion as the host has them, and writing to its first color
  /// buffer alone.
  void use_host_output() const;

 private:
  struct Unit {
    GLint texture_2d = 0, texture_array = 0, texture_buffer = 0, sampler = 0;
  };
  void take_bindings();
  void take_fixed_function();
  void put_back_bindings() const;
  void put_back_fixed_function() const;
  void neutral() const;

  const Gl& gl_;
  FixedFunctionState fixed_function_;
  GLint program_ = 0, vertex_array_ = 0, array_buffer_ = 0, draw_framebuffer_ = 0, read_framebuffer_ = 0;
  GLint pixel_pack_buffer_ = 0, pixel_unpack_buffer_ = 0, active_texture_ = 0, feedback_buffer_ = 0;
  GLint indexed_feedback_ = 0;
  GLint64 indexed_start_ = 0, indexed_size_ = 0;
  std::array<Unit, kUnits> units_;
  static constexpr int kPixelStores = 16;
  std::array<GLint, kPixelStores> pixel_stores_{};
  static constexpr int kDepthTest = 0, kScissor = 1, kSrgb = 4;
  static constexpr int kCapabilities = 23;
  std::array<bool, kCapabilities> enabled_{};
  struct Viewport {
    std::array<GLfloat, 4> box{};
    std::array<GLint, 4> scissor{};
    std::array<GLdouble, 2> depth_range{};
    bool scissored = false;
  };
  void take_viewports();
  void put_back_viewports() const;
  void put_back_blending() const;

  std::vector<bool> blend_;  ///< per draw buffer
  std::vector<std::array<GLboolean, 4>> color_mask_;
  std::array<GLint, 2> polygon_mode_{};
  GLint depth_func_ = 0, cull_face_ = 0, front_face_ = 0, clip_origin_ = 0, clip_depth_ = 0;
  std::array<GLint, 4> viewport_{}, scissor_{};
  std::vector<std::array<GLint, 6>> blend_state_;  ///< per draw buffer, or one for all
  std::vector<Viewport> viewports_;                ///< where there are several
  std::array<double, 2> depth_range_{};
  GLboolean depth_mask_ = GL_TRUE;
};

}  // namespace dupin

#endif
