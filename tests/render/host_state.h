// A host's OpenGL state, as far as it can be asked for, and a host that has set all of it to something
// unusual.
#ifndef DUPIN_TESTS_RENDER_HOST_STATE_H
#define DUPIN_TESTS_RENDER_HOST_STATE_H

#include <map>
#include <string>
#include <vector>

#include "../../render/context.h"

namespace dupin::testing {

/// Everything that glGet… answers about pipeline state and bindings, by name.
using GlState = std::map<std::string, std::vector<double>>;
GlState gl_state(const Context& context);

/// Every name whose values differ, a line each.
std::string differences(const GlState& before, const GlState& after);

/// Binds objects to every binding point and gives every switch and number a value that is not the default: a
/// framebuffer of its own of this size, color and depth, is bound for drawing, and another for reading. No
/// feedback or query is active.
void set_unusual_state(const Context& context, int width, int height);

/// Binds the context's own framebuffer for drawing and reading.
void draw_into_window(const Context& context);

/// What a compatibility context has besides; nothing in a core one.
void add_fixed_function_state(const Context& context, GlState& state);
void set_unusual_fixed_function(const Context& context);

/// The error that is recorded in the context; GL_NO_ERROR: none.
unsigned gl_error(const Context& context);

}  // namespace dupin::testing

#endif
