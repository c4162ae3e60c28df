// The two ways to a context, and the dynamic libraries behind them.
#ifndef DUPIN_RENDER_CONTEXT_BACKENDS_H
#define DUPIN_RENDER_CONTEXT_BACKENDS_H

#include <initializer_list>

#include "context.h"

namespace dupin {

Result<std::unique_ptr<Context>> create_egl_context();
Result<std::unique_ptr<Context>> create_osmesa_context();

/// The first of the names that dlopen finds, or null. Never closed: drivers leave threads and exit handlers
/// behind.
void* open_library(std::initializer_list<const char*> names);
void* find_symbol(void* library, const char* name);

template <class F>
bool find_function(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(find_symbol(library, name));
  return function != nullptr;
}

}  // namespace dupin

#endif
