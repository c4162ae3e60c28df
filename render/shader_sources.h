// The texts of shaders/*, by file name.
#ifndef DUPIN_RENDER_SHADER_SOURCES_H
#define DUPIN_RENDER_SHADER_SOURCES_H

#include <string_view>

namespace dupin {

/// Empty for a name that there is not.
std::string_view shader_source(std::string_view name);

}  // namespace dupin

#endif
