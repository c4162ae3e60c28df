#include "colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace dupin::app {
namespace {

// CSS 1's sixteen names and orange.
constexpr std::array<std::pair<const char*, unsigned>, 18> kNames{{{"black", 0x000000},
                                                                   {"silver", 0xc0c0c0},
                                                                   {"gray", 0x808080},
                                                                   {"grey", 0x808080},
                                                                   {"white", 0xffffff},
                                                                   {"maroon", 0x800000},
                                                                   {"red", 0xff0000},
                                                                   {"purple", 0x800080},
                                                                   {"fuchsia", 0xff00ff},
                                                                   {"green", 0x008000},
                                                                   {"lime", 0x00ff00},
                                                                   {"olive", 0x808000},
                                                                   {"yellow", 0xffff00},
                                                                   {"navy", 0x000080},
                                                                   {"blue", 0x0000ff},
                                                                   {"teal", 0x008080},
                                                                   {"aqua", 0x00ffff},
                                                                   {"orange", 0xffa500}}};

/// IEC 61966-2-1, both ways.
float to_linear(double s) {
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}
double to_srgb(double l) {
  return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

Color from_bytes(unsigned rgb, unsigned alpha) {
  return {to_linear((rgb >> 16 & 255) / 255.0), to_linear((rgb >> 8 & 255) / 255.0),
          to_linear((rgb & 255) / 255.0), static_cast<float>(alpha / 255.0)};
}

std::optional<Color> parse_hex(const std::string& digits) {
  if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) return {};
  const auto value = static_cast<unsigned>(std::strtoul(digits.c_str(), nullptr, 16));
  if (digits.size() == 8) return from_bytes(value >> 8, value & 255);
  if (digits.size() == 6) return from_bytes(value, 255);
  if (digits.size() == 3)
    return from_bytes((value >> 8 & 15) * 0x110000 + (value >> 4 & 15) * 0x1100 + (value & 15) * 0x11, 255);
  return {};
}

std::optional<Color> parse_numbers(const std::string& text) {
  double r = 0, g = 0, b = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &r, &g, &b, &used) != 3 ||
      used != static_cast<int>(text.size()))
    return {};
  for (double x : {r, g, b})
    if (!(x >= 0 && x <= 1)) return {};
  return Color{to_linear(r), to_linear(g), to_linear(b), 1};
}

}  // namespace

std::optional<Color> parse_color(const std::string& text) {
  for (const auto& [name, rgb] : kNames)
    if (text == name) return from_bytes(rgb, 255);
  return !text.empty() && text[0] == '#' ? parse_hex(text.substr(1)) : parse_numbers(text);
}

std::string hex_color(const Color& color) {
  const auto byte = [](double x) {
    return static_cast<unsigned>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
  };
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(to_srgb(color.r)), byte(to_srgb(color.g)),
                byte(to_srgb(color.b)));
  std::string hex = text;
  if (byte(color.a) != 255) {
    std::snprintf(text, sizeof text, "%02x", byte(color.a));
    hex += text;
  }
  return hex;
}

std::optional<Color> file_color(const Face& face, const Instance& instance, const Part& part) {
  if (face.color) return face.color;
  return instance.color ? instance.color : part.color;
}

}  // namespace dupin::app
