// What a file's own reader hands over for conversion: shapes in their places, with names and colours.
#ifndef DUPIN_CAD_IMPORT_READER_SOURCE_DOCUMENT_H
#define DUPIN_CAD_IMPORT_READER_SOURCE_DOCUMENT_H

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Trsf.hxx>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../../core/status.h"
#include "../../nurbs/model.h"

namespace dupin::reader {

/// Colours and names of subshapes, by what they are and where, whatever their orientation.
struct ShapeStyles {
  NCollection_DataMap<TopoDS_Shape, Color, TopTools_ShapeMapHasher> colors;
  NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher> names;
};

/// One shape in one place.
struct SourceItem {
  TopoDS_Shape shape;  ///< with its own location
  Affine3 placement;
  std::string part_name;
  std::string path;  ///< its path in the assembly
  std::optional<Color> part_color, instance_color;
  std::shared_ptr<const ShapeStyles> styles;  ///< may be null
};

struct SourceDocument {
  std::string format, unit_note;
  std::vector<SourceItem> items;
  std::vector<SkippedFace> skipped;  ///< faces that never became shapes
  std::vector<std::string> notes;
};

/// Reports a stage; false: stop.
using Stage = std::function<void(const char* stage, double fraction)>;

}  // namespace dupin::reader

#endif
