#include "gl_state.h"

namespace dupin {
namespace {

// In the order that GlStateGuard::kDepthTest, kScissor and kSrgb say.
constexpr GLenum kCapabilityNames[] = {GL_DEPTH_TEST,         GL_SCISSOR_TEST,
                                       GL_CULL_FACE,          GL_STENCIL_TEST,
                                       GL_FRAMEBUFFER_SRGB,   GL_POLYGON_OFFSET_FILL,
                                       GL_RASTERIZER_DISCARD, GL_PRIMITIVE_RESTART,
                                       GL_DEPTH_CLAMP,        GL_SAMPLE_ALPHA_TO_COVERAGE,
                                       GL_SAMPLE_COVERAGE,    GL_SAMPLE_MASK,
                                       GL_COLOR_LOGIC_OP,     GL_DITHER,
                                       GL_POLYGON_SMOOTH,     GL_CLIP_DISTANCE0,
                                       GL_CLIP_DISTANCE1,     GL_CLIP_DISTANCE2,
                                       GL_CLIP_DISTANCE3,     GL_CLIP_DISTANCE4,
                                       GL_CLIP_DISTANCE5,     GL_CLIP_DISTANCE6,
                                       GL_CLIP_DISTANCE7};
constexpr GLenum kPixelStoreNames[] = {
    GL_PACK_SWAP_BYTES,    GL_PACK_LSB_FIRST,   GL_PACK_ROW_LENGTH,    GL_PACK_IMAGE_HEIGHT,
    GL_PACK_SKIP_PIXELS,   GL_PACK_SKIP_ROWS,   GL_PACK_SKIP_IMAGES,   GL_PACK_ALIGNMENT,
    GL_UNPACK_SWAP_BYTES,  GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH,  GL_UNPACK_IMAGE_HEIGHT,
    GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_ALIGNMENT};
constexpr GLenum kBlendNames[] = {GL_BLEND_SRC_RGB,   GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,
                                  GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};

GLuint name(GLint value) {
  return static_cast<GLuint>(value);
}
GLenum symbol(GLint value) {
  return static_cast<GLenum>(value);
}

}  // namespace

GlStateGuard::GlStateGuard(const Gl& gl) : gl_(gl), fixed_function_(gl) {
  static_assert(std::size(kCapabilityNames) == kCapabilities && std::size(kPixelStoreNames) == kPixelStores);
  take_bindings();
  take_fixed_function();
  neutral();
}

GlStateGuard::~GlStateGuard() {
  fixed_function_.put_back();
  put_back_fixed_function();
  put_back_bindings();
}

void GlStateGuard::take_bindings() {
  gl_.GetIntegerv(GL_CURRENT_PROGRAM, &program_);
  gl_.GetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array_);
  gl_.GetIntegerv(GL_ARRAY_BUFFER_BINDING, &array_buffer_);
  gl_.GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_framebuffer_);
  gl_.GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_framebuffer_);
  gl_.GetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pixel_pack_buffer_);
  gl_.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &pixel_unpack_buffer_);
  gl_.GetIntegerv(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, &feedback_buffer_);
  gl_.GetIntegeri_v(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, &indexed_feedback_);
  gl_.GetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_START, 0, &indexed_start_);
  gl_.GetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, 0, &indexed_size_);
  gl_.GetIntegerv(GL_ACTIVE_TEXTURE, &active_texture_);
  for (int i = 0; i < kUnits; ++i) {
    Unit& unit = units_[static_cast<std::size_t>(i)];
    gl_.ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
    gl_.GetIntegerv(GL_TEXTURE_BINDING_2D, &unit.texture_2d);
    gl_.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &unit.texture_array);
    gl_.GetIntegerv(GL_TEXTURE_BINDING_BUFFER, &unit.texture_buffer);
    gl_.GetIntegerv(GL_SAMPLER_BINDING, &unit.sampler);
  }
  for (std::size_t i = 0; i < kPixelStores; ++i) gl_.GetIntegerv(kPixelStoreNames[i], &pixel_stores_[i]);
}

void GlStateGuard::take_fixed_function() {
  for (std::size_t i = 0; i < kCapabilities; ++i) enabled_[i] = gl_.IsEnabled(kCapabilityNames[i]);
  GLint buffers = 1;
  gl_.GetIntegerv(GL_MAX_DRAW_BUFFERS, &buffers);
  for (GLint i = 0; i < buffers; ++i) {
    const auto index = static_cast<GLuint>(i);
    blend_.push_back(gl_.IsEnabledi(GL_BLEND, index));
    gl_.GetBooleani_v(GL_COLOR_WRITEMASK, index, color_mask_.emplace_back().data());
  }
  gl_.GetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
  gl_.GetIntegerv(GL_DEPTH_FUNC, &depth_func_);
  gl_.GetIntegerv(GL_CULL_FACE_MODE, &cull_face_);
  gl_.GetIntegerv(GL_FRONT_FACE, &front_face_);
  gl_.GetIntegerv(GL_VIEWPORT, viewport_.data());
  gl_.GetIntegerv(GL_SCISSOR_BOX, scissor_.data());
  blend_state_.resize(gl_.BlendFuncSeparatei ? static_cast<std::size_t>(buffers) : 1);
  for (std::size_t i = 0; i < blend_state_.size(); ++i)
    for (std::size_t k = 0; k < std::size(kBlendNames); ++k) {
      GLint& value = blend_state_[i][k];
      if (gl_.BlendFuncSeparatei) gl_.GetIntegeri_v(kBlendNames[k], static_cast<GLuint>(i), &value);
      if (!gl_.BlendFuncSeparatei) gl_.GetIntegerv(kBlendNames[k], &value);
    }
  take_viewports();
  gl_.GetDoublev(GL_DEPTH_RANGE, depth_range_.data());
  gl_.GetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
  if (!gl_.ClipControl) return;
  gl_.GetIntegerv(GL_CLIP_ORIGIN, &clip_origin_);
  gl_.GetIntegerv(GL_CLIP_DEPTH_MODE, &clip_depth_);
}

void GlStateGuard::take_viewports() {
  if (!gl_.ViewportIndexedf) return;
  GLint count = 1;
  gl_.GetIntegerv(GL_MAX_VIEWPORTS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto index = static_cast<GLuint>(i);
    Viewport& viewport = viewports_.emplace_back();
    gl_.GetFloati_v(GL_VIEWPORT, index, viewport.box.data());
    gl_.GetIntegeri_v(GL_SCISSOR_BOX, index, viewport.scissor.data());
    gl_.GetDoublei_v(GL_DEPTH_RANGE, index, viewport.depth_range.data());
    viewport.scissored = gl_.IsEnabledi(GL_SCISSOR_TEST, index);
  }
}

void GlStateGuard::put_back_viewports() const {
  for (std::size_t i = 0; i < viewports_.size(); ++i) {
    const auto index = static_cast<GLuint>(i);
    const auto& [box, scissor, range, scissored] = viewports_[i];
    gl_.ViewportIndexedf(index, box[0], box[1], box[2], box[3]);
    gl_.ScissorIndexed(index, scissor[0], scissor[1], scissor[2], scissor[3]);
    gl_.DepthRangeIndexed(index, range[0], range[1]);
    (scissored ? gl_.Enablei : gl_.Disablei)(GL_SCISSOR_TEST, index);
  }
}

void GlStateGuard::put_back_blending() const {
  for (std::size_t i = 0; i < blend_state_.size(); ++i) {
    const auto& b = blend_state_[i];
    if (!gl_.BlendFuncSeparatei) {
      gl_.BlendFuncSeparate(symbol(b[0]), symbol(b[1]), symbol(b[2]), symbol(b[3]));
      gl_.BlendEquationSeparate(symbol(b[4]), symbol(b[5]));
      continue;
    }
    const auto index = static_cast<GLuint>(i);
    gl_.BlendFuncSeparatei(index, symbol(b[0]), symbol(b[1]), symbol(b[2]), symbol(b[3]));
    gl_.BlendEquationSeparatei(index, symbol(b[4]), symbol(b[5]));
  }
}

void GlStateGuard::neutral() const {
  fixed_function_.neutral();
  for (std::size_t i = 1; i < kCapabilities; ++i) gl_.Disable(kCapabilityNames[i]);
  gl_.Disable(GL_BLEND);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl_.DepthRange(0, 1);
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl_.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  for (const GLenum store : kPixelStoreNames)
    gl_.PixelStorei(store, store == GL_PACK_ALIGNMENT || store == GL_UNPACK_ALIGNMENT ? 4 : 0);
  for (int i = 0; i < kUnits; ++i) gl_.BindSampler(static_cast<GLuint>(i), 0);
  gl_.ActiveTexture(GL_TEXTURE0);
}

bool GlStateGuard::converts_to_srgb() const {
  if (!enabled_[kSrgb]) return false;
  // A window's buffers are asked about by other names than they are drawn to.
  GLint buffer = GL_NONE, encoding = GL_LINEAR;
  gl_.GetIntegerv(GL_DRAW_BUFFER0, &buffer);
  GLenum attachment = symbol(buffer);
  if (buffer == GL_NONE) return false;
  if (buffer == GL_BACK) attachment = GL_BACK_LEFT;
  if (buffer == GL_FRONT || buffer == GL_LEFT || buffer == GL_FRONT_AND_BACK) attachment = GL_FRONT_LEFT;
  if (buffer == GL_RIGHT) attachment = GL_FRONT_RIGHT;
  gl_.GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment,
                                          GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING, &encoding);
  return encoding == GL_SRGB;
}

void GlStateGuard::use_host_output() const {
  gl_.Scissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  for (const int i : {kDepthTest, kScissor, kSrgb})
    (enabled_[static_cast<std::size_t>(i)] ? gl_.Enable : gl_.Disable)(kCapabilityNames[i]);
  gl_.DepthFunc(symbol(depth_func_));
  gl_.DepthMask(depth_mask_);
  for (std::size_t i = 0; i < color_mask_.size(); ++i) {
    const std::array<GLboolean, 4> mask = i == 0 ? color_mask_[0] : std::array<GLboolean, 4>{};
    gl_.ColorMaski(static_cast<GLuint>(i), mask[0], mask[1], mask[2], mask[3]);
  }
}

void GlStateGuard::put_back_bindings() const {
  gl_.UseProgram(name(program_));
  gl_.BindVertexArray(name(vertex_array_));
  gl_.BindBuffer(GL_ARRAY_BUFFER, name(array_buffer_));
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, name(draw_framebuffer_));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, name(read_framebuffer_));
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, name(pixel_pack_buffer_));
  gl_.BindBuffer(GL_PIXEL_UNPACK_BUFFER, name(pixel_unpack_buffer_));
  if (indexed_feedback_ != 0 && indexed_size_ > 0) {
    gl_.BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, name(indexed_feedback_),
                        static_cast<GLintptr>(indexed_start_), static_cast<GLsizeiptr>(indexed_size_));
  } else {
    gl_.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, name(indexed_feedback_));
  }
  gl_.BindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, name(feedback_buffer_));  // binding an index binds this too
  for (int i = 0; i < kUnits; ++i) {
    const Unit& unit = units_[static_cast<std::size_t>(i)];
    gl_.ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
    gl_.BindTexture(GL_TEXTURE_2D, name(unit.texture_2d));
    gl_.BindTexture(GL_TEXTURE_2D_ARRAY, name(unit.texture_array));
    gl_.BindTexture(GL_TEXTURE_BUFFER, name(unit.texture_buffer));
    gl_.BindSampler(static_cast<GLuint>(i), name(unit.sampler));
  }
  gl_.ActiveTexture(symbol(active_texture_));
  for (std::size_t i = 0; i < kPixelStores; ++i) gl_.PixelStorei(kPixelStoreNames[i], pixel_stores_[i]);
}

void GlStateGuard::put_back_fixed_function() const {
  for (std::size_t i = 0; i < kCapabilities; ++i)
    (enabled_[i] ? gl_.Enable : gl_.Disable)(kCapabilityNames[i]);
  for (std::size_t i = 0; i < blend_.size(); ++i) {
    const auto index = static_cast<GLuint>(i);
    (blend_[i] ? gl_.Enablei : gl_.Disablei)(GL_BLEND, index);
    const auto& mask = color_mask_[i];
    gl_.ColorMaski(index, mask[0], mask[1], mask[2], mask[3]);
  }
  // Core profiles have one mode for both sides.
  if (gl_.compatibility()) {
    gl_.PolygonMode(GL_FRONT, symbol(polygon_mode_[0]));
    gl_.PolygonMode(GL_BACK, symbol(polygon_mode_[1]));
  } else {
    gl_.PolygonMode(GL_FRONT_AND_BACK, symbol(polygon_mode_[0]));
  }
  gl_.DepthFunc(symbol(depth_func_));
  gl_.CullFace(symbol(cull_face_));
  gl_.FrontFace(symbol(front_face_));
  gl_.Scissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  gl_.Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  put_back_blending();
  gl_.DepthRange(depth_range_[0], depth_range_[1]);
  put_back_viewports();
  gl_.DepthMask(depth_mask_);
  if (gl_.ClipControl) gl_.ClipControl(symbol(clip_origin_), symbol(clip_depth_));
}

}  // namespace dupin
