// Mending faces whose wires do not bound a region of the parameter plane.
#ifndef DUPIN_CAD_IMPORT_READER_REPAIR_H
#define DUPIN_CAD_IMPORT_READER_REPAIR_H

#include <TopoDS_Face.hxx>

#include <vector>

namespace dupin::reader {

/// The face with missing seams and natural boundaries added and its wires put in order, by OCCT's shape
/// healing; several if it fell apart, none if nothing came of it. Orientation is kept.
std::vector<TopoDS_Face> repaired(const TopoDS_Face& face);

}  // namespace dupin::reader

#endif
