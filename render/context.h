// OpenGL contexts of our own, without a window: EGL or OSMesa, both found at run time, so that neither is
// needed to link or start.
//
// A host that has a context of its own needs none of this: see renderer.h.
#ifndef DUPIN_RENDER_CONTEXT_H
#define DUPIN_RENDER_CONTEXT_H

#include <functional>
#include <memory>
#include <string>

#include "../core/status.h"

namespace dupin {

/// A context's own loader: eglGetProcAddress, glXGetProcAddress, QOpenGLContext::getProcAddress, …
using GetProcAddress = std::function<void*(const char* name)>;

enum class Device {
  automatic,  ///< EGL, then OSMesa
  egl,        ///< the surfaceless platform, then every EGL device
  osmesa,     ///< Mesa's off-screen software renderer
};

/// An OpenGL 3.3 core context, current on the thread that created it. Use and destroy it on one thread at a
/// time.
class Context {
 public:
  virtual ~Context() = default;
  virtual Status make_current() = 0;
  /// No context is current on this thread afterwards.
  virtual void release() = 0;
  virtual void* proc_address(const char* name) const = 0;
  /// "EGL surfaceless", "EGL device 0", "OSMesa".
  virtual std::string name() const = 0;
  GetProcAddress loader() const {
    return [this](const char* name) { return proc_address(name); };
  }
};

/// Creates a context and makes it current; StatusCode::no_device with what each way answered when there is
/// none.
Result<std::unique_ptr<Context>> create_context(Device device);

}  // namespace dupin

#endif
