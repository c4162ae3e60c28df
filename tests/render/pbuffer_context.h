// Contexts with a framebuffer of their own, as a window's: an EGL pbuffer with depth and stencil.
#ifndef DUPIN_TESTS_RENDER_PBUFFER_CONTEXT_H
#define DUPIN_TESTS_RENDER_PBUFFER_CONTEXT_H

#include "../../render/context.h"

namespace dupin::testing {

enum class Profile { core, compatibility };

/// Current, with the pbuffer as its framebuffer 0. no_device where there is no EGL that has them.
Result<std::unique_ptr<Context>> create_pbuffer_context(Profile profile, int width, int height);

}  // namespace dupin::testing

#endif
