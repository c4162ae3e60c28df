#include "current_context.h"

#include <dlfcn.h>

namespace dupin::python {
namespace {

using Function = void* (*)();
using Lookup = void* (*)(const char*);

/// A way to make contexts: its library, what asks for the current one, and what finds functions.
struct Way {
  const char *library, *current, *lookup;
};
constexpr Way kWays[] = {{"libEGL.so.1", "eglGetCurrentContext", "eglGetProcAddress"},
                         {"libGLX.so.0", "glXGetCurrentContext", "glXGetProcAddressARB"},
                         {"libGL.so.1", "glXGetCurrentContext", "glXGetProcAddressARB"},
                         {"libOSMesa.so.8", "OSMesaGetCurrentContext", "OSMesaGetProcAddress"}};

}  // namespace

GetProcAddress current_proc_address() {
  for (const Way& way : kWays) {
    // One that nobody has loaded has no current context either.
    void* library = ::dlopen(way.library, RTLD_LAZY | RTLD_NOLOAD);
    if (!library) continue;
    const auto current = reinterpret_cast<Function>(::dlsym(library, way.current));
    const auto lookup = reinterpret_cast<Lookup>(::dlsym(library, way.lookup));
    if (current && lookup && current()) return [lookup](const char* name) { return lookup(name); };
    ::dlclose(library);
  }
  return {};
}

}  // namespace dupin::python
