// A CAD file as a Model, in this process: what dupin-reader does, and what tests hold against OCCT.
#ifndef DUPIN_CAD_IMPORT_READER_IMPORT_SHAPES_H
#define DUPIN_CAD_IMPORT_READER_IMPORT_SHAPES_H

#include "mesh.h"
#include "read_files.h"

namespace dupin::reader {

struct ImportRequest {
  std::string path;
  ReadOptions read;
  MeshOptions mesh;
};

/// The file's shapes, by whichever reader its content asks for.
Result<SourceDocument> read_document(const ImportRequest& request, const Stage& stage);

/// May throw OCCT's exceptions.
Result<Model> import_shapes(const ImportRequest& request, const Stage& stage);

}  // namespace dupin::reader

#endif
