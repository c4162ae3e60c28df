// A whole document of shapes as a Model.
#ifndef DUPIN_CAD_IMPORT_READER_CONVERT_H
#define DUPIN_CAD_IMPORT_READER_CONVERT_H

#include "mesh.h"
#include "source_document.h"

namespace dupin::reader {

/// Splits every item into pieces (its solids; its other faces together), stores each distinct piece once as a
/// part, and tessellates them if that was asked for.
Model convert(const SourceDocument& document, const MeshOptions& mesh, const Stage& stage);

}  // namespace dupin::reader

#endif
