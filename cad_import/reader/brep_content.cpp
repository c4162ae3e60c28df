#include "brep_content.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <Standard_Failure.hxx>

#include <algorithm>
#include <ios>
#include <sstream>

#include "../file_kind.h"

namespace dupin::reader {

TopoDS_Shape read_brep_content(std::string content) {
  const std::size_t head = std::min(content.size(), kFileHeadBytes);
  const bool binary = find_file_kind(std::span(content).first(head)) == FileKind::brep_binary;
  // The last number must not be the end of the stream: an end is a fault then.
  content += "\n\n";
  std::istringstream in(std::move(content));
  in.exceptions(std::ios::eofbit | std::ios::failbit | std::ios::badbit);
  TopoDS_Shape shape;
  try {
    if (binary)
      BinTools::Read(shape, in);
    else
      BRepTools::Read(shape, in, BRep_Builder());
  } catch (const std::ios_base::failure&) {
    return {};
  } catch (const Standard_Failure&) {
    return {};
  }
  return shape;
}

}  // namespace dupin::reader
