// One piece of a file's topology (a solid, or loose shells and faces) as a Part.
#ifndef DUPIN_CAD_IMPORT_READER_PART_BUILDER_H
#define DUPIN_CAD_IMPORT_READER_PART_BUILDER_H

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <optional>
#include <string>
#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

struct FaceSource {
  TopoDS_Face face;  ///< oriented as in its piece
  std::optional<Color> color;
  std::string name;
};

struct PartSource {
  std::string name;
  std::optional<Color> color;
  std::vector<FaceSource> faces;
};

struct BuiltPart {
  Part part;
  std::vector<TopoDS_Face> shapes;  ///< the face of OCCT's that became part.faces[i]
  std::vector<SkippedFace> skipped;
  std::vector<std::string> notes;  ///< what was repaired or assumed; without the part's name
};

BuiltPart build_part(const PartSource& source);

}  // namespace dupin::reader

#endif
