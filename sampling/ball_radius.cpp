#include "ball_radius.h"

#include <algorithm>
#include <cmath>

namespace dupin {
namespace {

/// The farthest of the samples around one of a grid; 0 where there is none.
double farthest_around(const PartPoints& part, const SampleGrid& grid, std::uint32_t i, std::uint32_t j,
                       const DifferentialPoint& center) {
  double farthest = 0;
  for (std::uint32_t r = i == 0 ? 0 : i - 1; r <= std::min(i + 1, grid.rows - 1); ++r)
    for (std::uint32_t c = j == 0 ? 0 : j - 1; c <= std::min(j + 1, grid.columns - 1); ++c) {
      const std::uint32_t neighbor = part.grid_points[grid.first + r * grid.columns + c];
      if (neighbor != kNoPoint)
        farthest = std::max(farthest, distance(center.position, part.points[neighbor].position));
    }
  return farthest;
}

void add_neighbors(const PartPoints& part, std::vector<float>& radii) {
  for (const auto& [a, b] : part.edges) {
    const auto d = static_cast<float>(distance(part.points[a].position, part.points[b].position));
    radii[a] = std::max(radii[a], d);
    radii[b] = std::max(radii[b], d);
  }
  for (const SampleGrid& grid : part.grids) {
    float largest = 0;
    const auto for_each = [&](const auto& what) {
      for (std::uint32_t i = 0; i < grid.rows; ++i)
        for (std::uint32_t j = 0; j < grid.columns; ++j)
          if (const std::uint32_t p = part.grid_points[grid.first + i * grid.columns + j]; p != kNoPoint)
            what(i, j, p);
    };
    for_each([&](std::uint32_t i, std::uint32_t j, std::uint32_t p) {
      radii[p] = static_cast<float>(farthest_around(part, grid, i, j, part.points[p]));
      largest = std::max(largest, radii[p]);
    });
    for_each([&](std::uint32_t, std::uint32_t, std::uint32_t p) {
      if (radii[p] == 0) radii[p] = largest;
    });
  }
}

}  // namespace

std::vector<float> ball_radii(const PartPoints& part) {
  std::vector<float> radii(part.points.size(), 0);
  if (!part.pruned) add_neighbors(part, radii);
  const float largest = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (radii[i] > 0) continue;
    const auto own = static_cast<float>(2 * std::hypot(part.points[i].half_u, part.points[i].half_v));
    radii[i] = largest > 0 ? std::min(largest, own) : own;
  }
  return radii;
}

}  // namespace dupin
