#include "gl.h"

#include <cstring>

namespace dupin {
namespace {

template <class F>
bool load(F& function, const GetProcAddress& get, const std::string& name) {
  void* address = get(name.c_str());
  static_assert(sizeof(address) == sizeof(function));
  std::memcpy(&function, &address, sizeof(address));
  return address != nullptr;
}

bool has_extension(const Gl& gl, const char* wanted) {
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name = reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (name && std::strcmp(name, wanted) == 0) return true;
  }
  return false;
}

void load_indexed(Gl& gl, const GetProcAddress& get, int version) {
  if (version >= 40) {
    load(gl.BlendFuncSeparatei, get, "glBlendFuncSeparatei");
    load(gl.BlendEquationSeparatei, get, "glBlendEquationSeparatei");
  }
  if (version < 41) return;
  load(gl.ViewportIndexedf, get, "glViewportIndexedf");
  load(gl.ScissorIndexed, get, "glScissorIndexed");
  load(gl.DepthRangeIndexed, get, "glDepthRangeIndexed");
  load(gl.GetFloati_v, get, "glGetFloati_v");
  load(gl.GetDoublei_v, get, "glGetDoublei_v");
}

}  // namespace

Result<Gl> load_gl(const GetProcAddress& get_proc_address) {
  Gl gl;
  std::string missing;
#define DUPIN_GL_LOAD(type, name) \
  if (!load(gl.name, get_proc_address, "gl" #name) && missing.empty()) missing = "gl" #name;
  DUPIN_GL_FUNCTIONS(DUPIN_GL_LOAD)
#undef DUPIN_GL_LOAD
  if (!gl.GetString || !gl.GetIntegerv || !gl.GetString(GL_VERSION))
    return {StatusCode::no_device, "no OpenGL context is current"};
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 33)
    return {StatusCode::no_device,
            "OpenGL 3.3 is needed, the context has " + std::to_string(major) + "." + std::to_string(minor)};
  if (!missing.empty()) return {StatusCode::no_device, "the OpenGL context lacks " + missing};
  if (major * 10 + minor >= 45 || has_extension(gl, "GL_ARB_clip_control"))
    load(gl.ClipControl, get_proc_address, "glClipControl");
  GLint profile = 0;
  gl.GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  if (!(profile & GL_CONTEXT_CORE_PROFILE_BIT)) load(gl.PixelTransferf, get_proc_address, "glPixelTransferf");
  load_indexed(gl, get_proc_address, major * 10 + minor);
  return gl;
}

}  // namespace dupin
