// What is left of the fixed function in a compatibility context and reaches into drawing by shaders, into
// reading and into uploading: the alpha test, polygon stipple, clamping of colors and pixel transfer.
//
// Fog, lighting, texture environments, matrices and client arrays do not take part where a shader stands for
// them, and are never touched.
#ifndef DUPIN_RENDER_GL_FIXED_FUNCTION_H
#define DUPIN_RENDER_GL_FIXED_FUNCTION_H

#include <array>

#include "gl.h"

namespace dupin {

/// Taken on construction; a core context has only the clamping of what is read.
class FixedFunctionState {
 public:
  explicit FixedFunctionState(const Gl& gl);
  void neutral() const;
  void put_back() const;

 private:
  const Gl& gl_;
  bool alpha_test_ = false, stipple_ = false;
  std::array<GLint, 3> clamps_{};
  std::array<GLfloat, 14> transfers_{};
};

}  // namespace dupin

#endif
