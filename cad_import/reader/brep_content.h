// A BREP file's content as a shape.
#ifndef DUPIN_CAD_IMPORT_READER_BREP_CONTENT_H
#define DUPIN_CAD_IMPORT_READER_BREP_CONTENT_H

#include <TopoDS_Shape.hxx>

#include <string>

namespace dupin::reader {

/// The shape in a BREP file's bytes, text or binary; null if they are damaged. OCCT's own reading of a file
/// goes round in circles for ever where the file ends too early; this ends.
TopoDS_Shape read_brep_content(std::string content);

}  // namespace dupin::reader

#endif
