// What a PLY file says of itself: its elements and their properties.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_PLY_HEADER_H
#define DUPIN_CAD_IMPORT_MESH_FILES_PLY_HEADER_H

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "../../core/status.h"

namespace dupin::mesh_files {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr std::size_t byte_size(PlyType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}
constexpr bool is_float(PlyType type) {
  return type >= PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type{};
  bool list = false;
  PlyType count_type{};  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  /// The fewest bytes that one takes in the file.
  std::size_t least_bytes(bool text) const;
};

struct PlyHeader {
  enum class Format : std::uint8_t { text, little_endian, big_endian };
  Format format{};
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< of the header itself
  std::size_t lines = 0;
};

Result<PlyHeader> read_ply_header(std::string_view bytes);

}  // namespace dupin::mesh_files

#endif
