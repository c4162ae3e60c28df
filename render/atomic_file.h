// A file that appears whole or not at all.
#ifndef DUPIN_RENDER_ATOMIC_FILE_H
#define DUPIN_RENDER_ATOMIC_FILE_H

#include <cstddef>
#include <string>
#include <vector>

#include "../core/status.h"

namespace dupin {

/// Writes the bytes under a temporary name in the target's folder and renames it. What is no regular file is
/// written as it is.
Status write_file(const std::string& path, const std::vector<char>& bytes);

}  // namespace dupin

#endif
