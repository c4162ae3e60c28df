// Finding OpenGL's functions in whatever context is current, without linking to any of the ways to make one.
#ifndef DUPIN_INTEGRATIONS_PYTHON_CURRENT_CONTEXT_H
#define DUPIN_INTEGRATIONS_PYTHON_CURRENT_CONTEXT_H

#include "../../render/context.h"

namespace dupin::python {

/// By EGL, GLX or OSMesa, whichever has a current context on this thread; empty if none has.
GetProcAddress current_proc_address();

}  // namespace dupin::python

#endif
