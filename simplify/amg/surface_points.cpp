#include "../surface_points.h"

#include <algorithm>

namespace dupin {

Status check(const SurfacePoints& points) {
  const auto bad = [](const char* why) { return Status{StatusCode::invalid_argument, why}; };
  const std::size_t n = points.size();
  if (n > 0xfffffff0U) return {StatusCode::limit, "more points than 32 bits can number"};
  const auto fits = [n](const auto& list) { return list.empty() || list.size() == n; };
  if (!fits(points.normals) || !fits(points.colors) || !fits(points.faces))
    return bad("a list that is not as long as that of the points");
  if (points.triangles.size() % 3 != 0) return bad("triangles that have not three corners");
  if (std::any_of(points.triangles.begin(), points.triangles.end(), [n](std::uint32_t i) { return i >= n; }))
    return bad("a triangle with a corner that there is not");
  const auto finite = [](const std::vector<Vec3>& list) {
    return std::all_of(list.begin(), list.end(), is_finite);
  };
  if (!finite(points.positions) || !finite(points.normals))
    return bad("a point with a coordinate that is no number");
  return {};
}

}  // namespace dupin
