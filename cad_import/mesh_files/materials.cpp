#include "materials.h"

#include <algorithm>
#include <cmath>

#include "text_cursor.h"

namespace dupin::mesh_files {
namespace {

bool read_diffuse(TextCursor& text, Color& color) {
  double c[3];
  for (double& x : c) {
    const auto value = to_number(text.word());
    if (!value || !std::isfinite(*value)) return false;
    x = *value;
  }
  color.r = srgb_to_linear(c[0]), color.g = srgb_to_linear(c[1]), color.b = srgb_to_linear(c[2]);
  return true;
}

}  // namespace

float srgb_to_linear(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

void add_materials(std::string_view bytes, std::map<std::string, Color, std::less<>>& materials) {
  Color* current = nullptr;
  for (TextCursor text(bytes); !text.at_end(); text.next_line()) {
    const std::string_view key = text.word();
    if (key == "newmtl") {
      current = &materials[std::string(text.rest())];
      *current = {0.8F, 0.8F, 0.8F, 1};
    } else if (current && key == "Kd") {
      read_diffuse(text, *current);
    } else if (current && (key == "d" || key == "Tr")) {
      const auto value = to_number(text.word());
      if (!value || !(*value >= 0 && *value <= 1)) continue;
      current->a = static_cast<float>(key == "d" ? *value : 1 - *value);
    }
  }
}

}  // namespace dupin::mesh_files
