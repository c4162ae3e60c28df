// A mesh file as a Model of one part.
#ifndef DUPIN_CAD_IMPORT_READER_IMPORT_MESH_H
#define DUPIN_CAD_IMPORT_READER_IMPORT_MESH_H

#include <string>

#include "../file_kind.h"
#include "source_document.h"

namespace dupin::reader {

struct MeshRequest {
  FileKind kind{};
  std::string path;          ///< of the bytes to read
  std::string named_path;    ///< the file's own, where that is another: beside it lie the files that it names
  std::string assumed_unit;  ///< mesh files have none
};

Result<Model> import_mesh(const MeshRequest& request, const Stage& stage);

}  // namespace dupin::reader

#endif
