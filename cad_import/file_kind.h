// What kind of CAD or mesh file some bytes are, from the bytes alone.
#ifndef DUPIN_CAD_IMPORT_FILE_KIND_H
#define DUPIN_CAD_IMPORT_FILE_KIND_H

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "../core/status.h"

namespace dupin {

enum class FileKind {
  unknown,
  empty,
  step,
  iges,
  brep_text,
  brep_binary,
  zip,
  gzip,
  obj,
  ply,
  stl_text,
  stl_binary,
  off
};

/// Of those that hold polygons rather than exact faces.
constexpr bool is_mesh(FileKind kind) {
  return kind >= FileKind::obj;
}

/// How many bytes from the beginning `find_file_kind` wants to see.
inline constexpr std::size_t kFileHeadBytes = 8192;

/// `file_bytes`: the size of the whole file, by which a binary STL file is known; 0: that of the head. `name`
/// is only asked where the bytes say nothing: OBJ and STL have no signature.
FileKind find_file_kind(std::span<const char> head, std::uint64_t file_bytes = 0, std::string_view name = {});

/// What `unknown` is not, for messages.
inline constexpr std::string_view kSupportedKinds = "STEP, IGES, BREP, FCStd, OBJ, PLY, STL or OFF";

/// "STEP", "IGES", "BREP", … for messages and Model::format.
std::string_view kind_name(FileKind kind);

/// The kind of a file on disk. Fails with one line where it is missing, no regular file, or cannot be read;
/// an unknown or empty file is a kind, not a failure. `name` is the
/// file's own where `path` is not (an unpacked one's).
Result<FileKind> file_kind(const std::string& path, std::string_view name = {});

}  // namespace dupin

#endif
