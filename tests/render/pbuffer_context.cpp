#include "pbuffer_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "../../render/context_backends.h"

namespace dupin::testing {
namespace {

struct Egl {
  decltype(&eglGetProcAddress) get_proc_address = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglChooseConfig) choose_config = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;
  decltype(&eglCreatePbufferSurface) create_pbuffer = nullptr;
  decltype(&eglDestroySurface) destroy_surface = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
};

bool load(Egl& egl) {
  void* library = open_library({"libEGL.so.1"});
  if (!library || !find_function(library, "eglGetProcAddress", egl.get_proc_address) ||
      !find_function(library, "eglInitialize", egl.initialize) ||
      !find_function(library, "eglBindAPI", egl.bind_api) ||
      !find_function(library, "eglChooseConfig", egl.choose_config) ||
      !find_function(library, "eglCreateContext", egl.create_context) ||
      !find_function(library, "eglDestroyContext", egl.destroy_context) ||
      !find_function(library, "eglCreatePbufferSurface", egl.create_pbuffer) ||
      !find_function(library, "eglDestroySurface", egl.destroy_surface) ||
      !find_function(library, "eglMakeCurrent", egl.make_current))
    return false;
  egl.get_platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.get_proc_address("eglGetPlatformDisplayEXT"));
  return egl.get_platform_display != nullptr;
}

class PbufferContext final : public Context {
 public:
  PbufferContext(const Egl& egl, EGLDisplay display, EGLSurface surface, EGLContext context)
      : egl_(egl), display_(display), surface_(surface), context_(context) {}
  ~PbufferContext() override {
    release();
    egl_.destroy_context(display_, context_);
    egl_.destroy_surface(display_, surface_);
  }
  Status make_current() override {
    egl_.bind_api(EGL_OPENGL_API);
    if (egl_.make_current(display_, surface_, surface_, context_)) return {};
    return {StatusCode::no_device, "eglMakeCurrent failed"};
  }
  void release() override { egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  void* proc_address(const char* name) const override {
    return reinterpret_cast<void*>(egl_.get_proc_address(name));
  }
  std::string name() const override { return "EGL pbuffer"; }

 private:
  Egl egl_;
  EGLDisplay display_;
  EGLSurface surface_;
  EGLContext context_;
};

}  // namespace

Result<std::unique_ptr<Context>> create_pbuffer_context(Profile profile, int width, int height) {
  const auto fail = [](const char* what) {
    return Result<std::unique_ptr<Context>>(StatusCode::no_device, what);
  };
  Egl egl;
  if (!load(egl)) return fail("no EGL");
  const EGLDisplay display =
      egl.get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || !egl.initialize(display, nullptr, nullptr)) return fail("no display");
  egl.bind_api(EGL_OPENGL_API);
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_DEPTH_SIZE,
                           24,
                           EGL_STENCIL_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl.choose_config(display, wanted, &config, 1, &count) || count == 0) return fail("no configuration");
  const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
  const EGLSurface surface = egl.create_pbuffer(display, config, size);
  const bool core = profile == Profile::core;
  const EGLint version[] = {
      EGL_CONTEXT_MAJOR_VERSION_KHR,
      3,
      EGL_CONTEXT_MINOR_VERSION_KHR,
      3,
      EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
      core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT_KHR,
      EGL_NONE};
  const EGLContext context = egl.create_context(display, config, EGL_NO_CONTEXT, version);
  if (surface == EGL_NO_SURFACE || context == EGL_NO_CONTEXT) return fail("no pbuffer with this profile");
  auto result = std::make_unique<PbufferContext>(egl, display, surface, context);
  const Status current = result->make_current();
  if (!current.ok()) return current;
  return std::unique_ptr<Context>(std::move(result));
}

}  // namespace dupin::testing
