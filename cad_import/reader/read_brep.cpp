#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>

#include "read_files.h"
#include "units.h"

namespace dupin::reader {

Result<SourceDocument> read_brep(const std::string& path, bool binary, const ReadOptions& options,
                                 const Stage& stage) {
  stage("reading", 0);
  TopoDS_Shape shape;
  const bool read = binary ? BinTools::Read(shape, path.c_str()) : BRepTools::Read(shape, path.c_str(), BRep_Builder());
  if (!read || shape.IsNull()) return {StatusCode::unreadable, "the BREP file is damaged or holds no shape"};
  SourceDocument document;
  document.format = "BREP";
  const double scale = millimetres(options.assumed_unit);
  document.unit_note = "no unit in the file; taken as " + options.assumed_unit;
  SourceItem item;
  item.shape = shape;
  item.placement.linear = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
  document.items.push_back(std::move(item));
  return document;
}

}  // namespace dupin::reader
