// EGL without a window system: EGL_MESA_platform_surfaceless, then EGL_EXT_platform_device on every device.
//
// The display of a platform is one object a process, whoever asks for it, so it is initialised and never
// terminated: terminating it would end the contexts that others have on it.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <vector>

#include "context_backends.h"

namespace dupin {
namespace {

struct Egl {
  decltype(&eglGetProcAddress) get_proc_address = nullptr;
  decltype(&eglQueryString) query_string = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglChooseConfig) choose_config = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;
  decltype(&eglCreatePbufferSurface) create_pbuffer = nullptr;
  decltype(&eglDestroySurface) destroy_surface = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  decltype(&eglGetError) get_error = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
};

bool load(Egl& egl) {
  void* library = open_library({"libEGL.so.1", "libEGL.so"});
  if (!library) return false;
  const bool complete = find_function(library, "eglGetProcAddress", egl.get_proc_address) &&
                        find_function(library, "eglQueryString", egl.query_string) &&
                        find_function(library, "eglInitialize", egl.initialize) &&
                        find_function(library, "eglBindAPI", egl.bind_api) &&
                        find_function(library, "eglChooseConfig", egl.choose_config) &&
                        find_function(library, "eglCreateContext", egl.create_context) &&
                        find_function(library, "eglDestroyContext", egl.destroy_context) &&
                        find_function(library, "eglCreatePbufferSurface", egl.create_pbuffer) &&
                        find_function(library, "eglDestroySurface", egl.destroy_surface) &&
                        find_function(library, "eglMakeCurrent", egl.make_current) &&
                        find_function(library, "eglGetError", egl.get_error);
  if (!complete) return false;
  egl.get_platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.get_proc_address("eglGetPlatformDisplayEXT"));
  egl.query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.get_proc_address("eglQueryDevicesEXT"));
  return true;
}

std::string error_text(const Egl& egl, const char* what) {
  static const char* const kDigits = "0123456789abcdef";
  const unsigned code = static_cast<unsigned>(egl.get_error());
  std::string hex = "0x";
  for (int shift = 12; shift >= 0; shift -= 4) hex += kDigits[(code >> shift) & 15];
  return std::string(what) + " failed (" + hex + ")";
}

bool has_word(const char* list, const char* word) {
  const std::size_t n = std::strlen(word);
  for (const char* p = list; p && (p = std::strstr(p, word)); p += n)
    if ((p == list || p[-1] == ' ') && (p[n] == ' ' || p[n] == '\0')) return true;
  return false;
}

class EglContext final : public Context {
 public:
  EglContext(const Egl& egl, EGLDisplay display, EGLContext context, EGLSurface surface, std::string name)
      : egl_(egl), display_(display), context_(context), surface_(surface), name_(std::move(name)) {}
  ~EglContext() override {
    release();
    egl_.destroy_context(display_, context_);
    if (surface_ != EGL_NO_SURFACE) egl_.destroy_surface(display_, surface_);
  }
  Status make_current() override {
    egl_.bind_api(EGL_OPENGL_API);
    if (egl_.make_current(display_, surface_, surface_, context_)) return {};
    return {StatusCode::no_device, error_text(egl_, "eglMakeCurrent")};
  }
  void release() override {
    egl_.bind_api(EGL_OPENGL_API);
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  void* proc_address(const char* name) const override {
    return reinterpret_cast<void*>(egl_.get_proc_address(name));
  }
  std::string name() const override { return name_; }

 private:
  Egl egl_;
  EGLDisplay display_;
  EGLContext context_;
  EGLSurface surface_;
  std::string name_;
};

/// A context on one display, current; a one-pixel pbuffer stands in where contexts need a surface.
Result<std::unique_ptr<Context>> open_display(const Egl& egl, EGLDisplay display, std::string name) {
  const auto fail = [&](const char* what) {
    return Result<std::unique_ptr<Context>>(StatusCode::no_device, name + ": " + error_text(egl, what));
  };
  if (display == EGL_NO_DISPLAY) return fail("eglGetPlatformDisplay");
  EGLint major = 0, minor = 0;
  if (!egl.initialize(display, &major, &minor)) return fail("eglInitialize");
  if (!egl.bind_api(EGL_OPENGL_API)) return fail("eglBindAPI");
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl.choose_config(display, wanted, &config, 1, &count) || count == 0) return fail("eglChooseConfig");
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                            3,
                            EGL_CONTEXT_MINOR_VERSION_KHR,
                            3,
                            EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                            EGL_NONE};
  const EGLContext context = egl.create_context(display, config, EGL_NO_CONTEXT, version);
  if (context == EGL_NO_CONTEXT) return fail("eglCreateContext (OpenGL 3.3 core)");
  EGLSurface surface = EGL_NO_SURFACE;
  if (!has_word(egl.query_string(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = egl.create_pbuffer(display, config, size);
  }
  auto result = std::make_unique<EglContext>(egl, display, context, surface, name);
  const Status current = result->make_current();
  if (!current.ok()) return {current.code, name + ": " + current.message};
  return std::unique_ptr<Context>(std::move(result));
}

}  // namespace

Result<std::unique_ptr<Context>> create_egl_context() {
  Egl egl;
  if (!load(egl)) return {StatusCode::no_device, "EGL: libEGL.so.1 is not installed"};
  if (!egl.get_platform_display)
    return {StatusCode::no_device, "EGL: no platform displays (EGL_EXT_platform_base)"};
  const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::string reasons;
  if (has_word(client, "EGL_MESA_platform_surfaceless")) {
    auto result = open_display(
        egl, egl.get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
        "EGL surfaceless");
    if (result) return result;
    reasons = result.status().message;
  }
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (!egl.query_devices || !egl.query_devices(16, devices, &count)) count = 0;
  for (EGLint i = 0; i < count; ++i) {
    auto result = open_display(egl, egl.get_platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
                               "EGL device " + std::to_string(i));
    if (result) return result;
    reasons += (reasons.empty() ? "" : "; ") + result.status().message;
  }
  return {StatusCode::no_device,
          reasons.empty() ? "EGL: neither a surfaceless platform nor a device" : reasons};
}

}  // namespace dupin
