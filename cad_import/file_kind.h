// What kind of CAD file some bytes are, from the bytes alone.
#ifndef DUPIN_CAD_IMPORT_FILE_KIND_H
#define DUPIN_CAD_IMPORT_FILE_KIND_H

#include <span>
#include <string>
#include <string_view>

#include "../core/status.h"

namespace dupin {

enum class FileKind { unknown, empty, step, iges, brep_text, brep_binary, zip, gzip };

/// How many bytes from the beginning `find_file_kind` wants to see.
inline constexpr std::size_t kFileHeadBytes = 8192;

FileKind find_file_kind(std::span<const char> head);

/// "STEP", "IGES", "BREP", … for messages and Model::format.
std::string_view kind_name(FileKind kind);

/// The kind of a file on disk. Fails with one line where it is missing, no regular file, or cannot be read;
/// an unknown or empty file is a kind, not a failure.
Result<FileKind> file_kind(const std::string& path);

}  // namespace dupin

#endif
