// How far the outlines of what two pictures show lie apart.
#include <array>
#include <cmath>
#include <limits>

#include "../core/parallel.h"
#include "metrics_detail.h"

namespace dupin {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Covered pixels beside one that is not; the picture's own border is no outline.
std::vector<std::uint8_t> outline(const std::vector<std::uint8_t>& covered, int width, int height) {
  std::vector<std::uint8_t> edge(covered.size(), 0);
  const auto at = [&](int x, int y) {
    return covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)] != 0;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool open = (x > 0 && !at(x - 1, y)) || (x + 1 < width && !at(x + 1, y)) ||
                        (y > 0 && !at(x, y - 1)) || (y + 1 < height && !at(x, y + 1));
      edge[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          at(x, y) && open;
    }
  return edge;
}

/// In place, of n values `stride` apart: min over j of f(j) + (i − j)², as the lower envelope of parabolas
/// (Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions).
void transform_line(float* values, std::size_t n, std::size_t stride) {
  std::vector<float> f(n);
  std::vector<std::size_t> apex;
  std::vector<double> from;
  for (std::size_t i = 0; i < n; ++i) f[i] = values[i * stride];
  for (std::size_t i = 0; i < n; ++i) {
    if (f[i] == kFar) continue;
    double start = -std::numeric_limits<double>::infinity();
    while (!apex.empty()) {
      const double p = static_cast<double>(apex.back()), q = static_cast<double>(i);
      start = ((f[i] + q * q) - (f[apex.back()] + p * p)) / (2 * (q - p));
      if (start > from.back()) break;
      apex.pop_back();
      from.pop_back();
      start = -std::numeric_limits<double>::infinity();
    }
    apex.push_back(i);
    from.push_back(start);
  }
  if (apex.empty()) return;
  std::size_t k = 0;
  for (std::size_t i = 0; i < n; ++i) {
    while (k + 1 < apex.size() && from[k + 1] < static_cast<double>(i)) ++k;
    const double d = static_cast<double>(i) - static_cast<double>(apex[k]);
    values[i * stride] = static_cast<float>(d * d + f[apex[k]]);
  }
}

/// The distance of every pixel's middle from that of the nearest one marked.
std::vector<float> distances(const std::vector<std::uint8_t>& marked, int width, int height) {
  std::vector<float> squares(marked.size());
  for (std::size_t i = 0; i < marked.size(); ++i) squares[i] = marked[i] ? 0 : kFar;
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  parallel_for(
      w, [&](std::size_t x) { transform_line(squares.data() + x, h, w); }, 32);
  parallel_for(
      h, [&](std::size_t y) { transform_line(squares.data() + y * w, w, 1); }, 32);
  for (float& square : squares) square = std::sqrt(square);
  return squares;
}

}  // namespace

Distribution outline_distances(const std::vector<std::uint8_t>& covered_a,
                               const std::vector<std::uint8_t>& covered_b, int width, int height) {
  const std::array<std::vector<std::uint8_t>, 2> edges{outline(covered_a, width, height),
                                                       outline(covered_b, width, height)};
  std::vector<float> found;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::vector<float> to_other = distances(edges[1 - side], width, height);
    for (std::size_t i = 0; i < to_other.size(); ++i)
      if (edges[side][i]) found.push_back(to_other[i]);
  }
  return distribution(found);
}

}  // namespace dupin
