#include <dlfcn.h>

#include "context_backends.h"

namespace dupin {

void* open_library(std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL)) return library;
  return nullptr;
}

void* find_symbol(void* library, const char* name) {
  return dlsym(library, name);
}

}  // namespace dupin
