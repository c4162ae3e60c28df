// Shapes of files, and models made from them in this process.
#ifndef DUPIN_TESTS_CAD_IMPORT_OCCT_FILES_H
#define DUPIN_TESTS_CAD_IMPORT_OCCT_FILES_H

#include <TopoDS_Shape.hxx>

#include <optional>
#include <string>
#include <vector>

#include "../../cad_import/reader/import_shapes.h"
#include "../../cad_import/reader/part_builder.h"

namespace dupin::test {

std::optional<reader::SourceDocument> read_document(const std::string& path);
reader::PartSource all_faces(const TopoDS_Shape& shape);
/// The faces of one shape as a part, their places within it baked in.
reader::BuiltPart build(const TopoDS_Shape& shape);

/// Files with every kind of surface, seam, pole and slip that the real set has.
const std::vector<std::string>& varied_files();

/// +1 inside, -1 outside, 0 too near to the boundary to say, by the parity of the loops' polygons.
int side_of_loops(const Part& part, const Face& face, Vec2 q);

}  // namespace dupin::test

#endif
