// OpenGL objects that free themselves; their context must be current then.
#ifndef DUPIN_RENDER_GL_OBJECTS_H
#define DUPIN_RENDER_GL_OBJECTS_H

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gl.h"

namespace dupin {

/// Texture units 0 … kUnits − 1 are the only ones that are used; the last is for making textures.
inline constexpr int kUnits = 14, kScratchUnit = 13;

/// A name made by one glGen… function and freed by its glDelete….
template <auto Generate, auto Delete>
class GlName {
 public:
  GlName() = default;
  explicit GlName(const Gl& gl) : gl_(&gl) { (gl.*Generate)(1, &name_); }
  GlName(GlName&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_) (gl_->*Delete)(1, &name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

using GlBuffer = GlName<&Gl::GenBuffers, &Gl::DeleteBuffers>;
using GlTexture = GlName<&Gl::GenTextures, &Gl::DeleteTextures>;
using GlFramebuffer = GlName<&Gl::GenFramebuffers, &Gl::DeleteFramebuffers>;
using GlVertexArray = GlName<&Gl::GenVertexArrays, &Gl::DeleteVertexArrays>;

class GlProgram {
 public:
  GlProgram() = default;
  GlProgram(const Gl& gl, GLuint name) : gl_(&gl), name_(name) {}
  GlProgram(GlProgram&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  GlProgram& operator=(GlProgram&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlProgram() {
    if (name_) gl_->DeleteProgram(name_);
  }
  GLuint name() const { return name_; }
  /// -1 where the program does not use it; OpenGL ignores what is set there.
  GLint uniform(const char* name) const { return gl_->GetUniformLocation(name_, name); }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

struct ProgramText {
  std::vector<std::string> vertex,
      fragment;  ///< names of shaders/ files, or texts (of several lines); no fragment shader: transform
                 ///< feedback only
  std::vector<std::string> defines;                ///< "NAME" or "NAME VALUE"
  std::vector<const char*> feedback;               ///< captured outputs, interleaved
  std::vector<std::pair<const char*, int>> units;  ///< samplers and their texture units
};
/// Compiles and links; leaves the program in use.
Result<GlProgram> build_program(const Gl& gl, const ProgramText& text);

/// A buffer seen through a texture buffer of a given format.
class TexelBuffer {
 public:
  TexelBuffer() = default;
  TexelBuffer(const Gl& gl, GLenum format) : gl_(&gl), format_(format), buffer_(gl), texture_(gl) {}
  /// Replaces the content; never empty on the GPU, so that fetches stay defined. `data` may be null.
  void assign(const void* data, std::size_t bytes, GLenum usage);
  /// Grows to at least `bytes`; the content is lost when it grows.
  void reserve(std::size_t bytes, GLenum usage);
  /// Replaces a part of the content; room for it must be there.
  void write(std::size_t offset, const void* data, std::size_t bytes);
  /// On texture unit `unit`.
  void bind(int unit) const;
  GLuint buffer() const { return buffer_.name(); }
  std::size_t bytes() const { return bytes_; }

 private:
  const Gl* gl_ = nullptr;
  GLenum format_ = 0;
  GlBuffer buffer_;
  GlTexture texture_;
  std::size_t bytes_ = 0;
};

}  // namespace dupin

#endif
