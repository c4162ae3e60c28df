// A thread with an OpenGL context of its own, so that drawing pictures never touches the context that the
// caller (a viewer's Python console, a notebook) has current.
#ifndef DUPIN_INTEGRATIONS_PYTHON_PICTURE_THREAD_H
#define DUPIN_INTEGRATIONS_PYTHON_PICTURE_THREAD_H

#include <functional>

#include "../../core/status.h"
#include "../../render/renderer.h"

namespace dupin::python {

/// Runs `work` there and waits; no_device where there is no context. The thread starts with the first call
/// and stays. After a fork there is none in the child: `limit`.
Status on_picture_thread(const std::function<Status(Renderer&)>& work);

}  // namespace dupin::python

#endif
