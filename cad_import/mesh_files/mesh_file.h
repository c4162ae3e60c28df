// Mesh files from their bytes: OBJ, PLY, STL and OFF, without any library behind them.
//
// Nothing in the bytes is believed: a count is compared with the bytes that are left before anything is
// allocated, every index with what it refers to, every number must be finite. What is refused says where: a
// line of a text, a byte of a binary file. What is accepted is kept as it is: non-manifold, degenerate,
// doubled.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_MESH_FILE_H
#define DUPIN_CAD_IMPORT_MESH_FILES_MESH_FILE_H

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../../core/status.h"
#include "../../nurbs/polygon_mesh.h"

namespace dupin::mesh_files {

struct MeshFile {
  std::string format;  ///< "OBJ", "PLY", "STL", "OFF"
  PolygonMesh mesh;    ///< passes check(mesh)
  std::vector<std::string> notes;
};

/// The content of a file that another one names (an OBJ's materials); none if it cannot be had.
using FindFile = std::function<std::optional<std::string>(std::string_view name)>;

Result<MeshFile> read_obj(std::string_view bytes, const FindFile& find_file = {});
Result<MeshFile> read_ply(std::string_view bytes);
Result<MeshFile> read_off(std::string_view bytes);
/// Corners at the same place become one vertex: the format has no other way to say that triangles are joined.
Result<MeshFile> read_stl_text(std::string_view bytes);
Result<MeshFile> read_stl_binary(std::string_view bytes);

/// Bytes of a binary STL file of that many triangles.
constexpr std::uint64_t stl_bytes(std::uint64_t triangles) {
  return 84 + 50 * triangles;
}

}  // namespace dupin::mesh_files

#endif
