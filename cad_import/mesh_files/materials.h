// Wavefront material libraries: their diffuse colours.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_MATERIALS_H
#define DUPIN_CAD_IMPORT_MESH_FILES_MATERIALS_H

#include <map>
#include <string>
#include <string_view>

#include "../../nurbs/color.h"

namespace dupin::mesh_files {

/// By name. What cannot be understood is passed over: a material is a look, never a shape.
void add_materials(std::string_view text, std::map<std::string, Color, std::less<>>& materials);

/// IEC 61966-2-1; what lies outside of 0 … 1 is clamped.
float srgb_to_linear(double s);

}  // namespace dupin::mesh_files

#endif
