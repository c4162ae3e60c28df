// Vertex colours that a text may give as 0 … 1 or as 0 … 255, and not for every vertex.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_COLOR_SCALE_H
#define DUPIN_CAD_IMPORT_MESH_FILES_COLOR_SCALE_H

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../../nurbs/polygon_mesh.h"

namespace dupin::mesh_files {

inline std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

class VertexColors {
 public:
  /// In order of the vertices; a negative alpha is none.
  void set(std::size_t vertex, const std::array<double, 4>& c) {
    if (values_.size() < vertex) values_.resize(vertex, kNone);
    values_.push_back({static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]),
                       static_cast<float>(c[3])});
    largest_ = std::max({largest_, c[0], c[1], c[2]});
  }
  /// None if no vertex has one; vertices without are white.
  std::vector<Rgba8> take(std::size_t vertices) {
    std::vector<Rgba8> colors;
    if (values_.empty()) return colors;
    const double scale = largest_ > 1 ? 1 : 255;
    for (const auto& c : values_)
      colors.push_back({to_byte(c[0] * scale), to_byte(c[1] * scale), to_byte(c[2] * scale),
                        to_byte(c[3] < 0 ? 255 : c[3] * scale)});
    colors.resize(vertices, {255, 255, 255, 255});
    values_ = {};
    return colors;
  }

 private:
  static constexpr std::array<float, 4> kNone{1e30F, 1e30F, 1e30F, -1};
  std::vector<std::array<float, 4>> values_;
  double largest_ = 0;
};

}  // namespace dupin::mesh_files

#endif
