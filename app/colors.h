// Colours as people write them. The library's are linear light; what people and files of pictures write is
// sRGB.
#ifndef DUPIN_APP_COLORS_H
#define DUPIN_APP_COLORS_H

#include <optional>
#include <string>

#include "../nurbs/model.h"

namespace dupin::app {

/// "#rgb", "#rrggbb", "#rrggbbaa", "R,G,B" with numbers 0 … 1, or one of the basic CSS names.
std::optional<Color> parse_color(const std::string& text);
/// "#rrggbb", with two more digits unless it is opaque.
std::string hex_color(const Color& color);
/// What a face of an instance is drawn in, if the file says so: its own colour, else the instance's, else the
/// part's.
std::optional<Color> file_color(const Face& face, const Instance& instance, const Part& part);

}  // namespace dupin::app

#endif
