#include "leaf_points.h"

#include <algorithm>
#include <cmath>

#include "../core/parallel.h"
#include "nearest_points.h"

namespace dupin {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::size_t kNeighbours = 8;  ///< that a point's normal is found across

/// The triangles' corners at each place, in the triangles' order; 3 t + k each.
struct CornersAtPlaces {
  std::vector<std::uint32_t> starts, corners;
  explicit CornersAtPlaces(const TreeMesh& mesh)
      : starts(mesh.place.size() + 1, 0), corners(3 * mesh.size()) {
    const auto each = [&](auto&& use) {
      for (std::uint32_t t = 0; t < mesh.size(); ++t)
        for (int k = 0; k < 3; ++k) use(mesh.place[mesh.vertex(t, k)], 3 * t + static_cast<std::uint32_t>(k));
    };
    each([&](std::uint32_t place, std::uint32_t) { ++starts[place + 1]; });
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    each([&](std::uint32_t place, std::uint32_t corner) { corners[next[place]++] = corner; });
  }
};

LeafPoint point_of_corners(const TreeMesh& mesh, const std::vector<Vec3>& grid, std::uint32_t place,
                           std::span<const std::uint32_t> corners) {
  LeafPoint point;
  point.sphere.center = grid[place];
  point.weight = 0;
  std::array<double, 3> color{};
  Vec3 normal, faces;
  bool closed = true;
  std::vector<Vec3> face_normals;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t t = corner / 3;
    const int k = static_cast<int>(corner % 3);
    const Vec3 &next = grid[mesh.vertex(t, (k + 1) % 3)], &last = grid[mesh.vertex(t, (k + 2) % 3)];
    for (const Vec3& other : {next, last})
      point.sphere.radius = std::max(point.sphere.radius, 0.5 * distance(point.sphere.center, other));
    const Vec3 area = cross(next - point.sphere.center, last - point.sphere.center);
    const double weight = std::max(1e-3, length(area));
    const auto& n = mesh.normals[mesh.corners[t][static_cast<std::size_t>(k)]];
    normal += Vec3{n[0], n[1], n[2]} * weight;
    faces += area;
    if (length(area) > 0) face_normals.push_back(area);
    const Rgba8 c = mesh.color(t, k);
    for (std::size_t i = 0; i < 3; ++i) color[i] += weight * c[i];
    point.weight += weight;
    closed = closed && mesh.closed[t];
  }
  for (std::size_t i = 0; i < 3; ++i)
    point.color[i] = static_cast<std::uint8_t>(std::lround(color[i] / point.weight));
  point.normal = normalized(normal);
  point.cone_axis = normalized(faces);
  point.group = mesh.group(corners[0] / 3);
  if (!closed || length(faces) == 0) return point;
  point.cone_half_angle = 0;
  for (const Vec3& n : face_normals)
    point.cone_half_angle = std::max(point.cone_half_angle,
                                     std::atan2(length(cross(point.cone_axis, n)), dot(point.cone_axis, n)));
  return point;
}

std::vector<LeafPoint> points_of_triangles(const TreeMesh& mesh, const std::vector<Vec3>& grid) {
  const CornersAtPlaces at(mesh);
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = 0; i < mesh.place.size(); ++i)
    if (at.starts[i] < at.starts[i + 1]) used.push_back(i);
  std::vector<LeafPoint> points(used.size());
  parallel_for(
      used.size(),
      [&](std::size_t i) {
        const std::uint32_t place = used[i];
        points[i] =
            point_of_corners(mesh, grid, place,
                             {at.corners.data() + at.starts[place], at.starts[place + 1] - at.starts[place]});
      },
      kGrain);
  return points;
}

/// Across the plane that fits the points best: the direction in which they extend least, by a few steps of
/// inverse iteration.
Vec3 plane_normal(std::span<const Vec3> points) {
  Vec3 mean;
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Mat3 m{{}, {}, {}};
  for (const Vec3& p : points) {
    const Vec3 d = p - mean;
    m.x += d * d.x, m.y += d * d.y, m.z += d * d.z;
  }
  const double trace = m.x.x + m.y.y + m.z.z;
  if (!(trace > 0)) return {0, 0, 1};
  m.x.x += 1e-9 * trace, m.y.y += 1e-9 * trace, m.z.z += 1e-9 * trace;
  const Mat3 inverted = inverse(m);
  Vec3 n{0.267, 0.535, 0.802};
  for (int i = 0; i < 12; ++i) n = normalized(inverted * n);
  return n;
}

std::vector<LeafPoint> lone_points(const TreeMesh& mesh, const std::vector<Vec3>& grid) {
  std::vector<std::uint32_t> used;
  std::vector<Vec3> positions;
  for (std::uint32_t i = 0; i < mesh.place.size(); ++i)
    if (mesh.place[i] == i) used.push_back(i), positions.push_back(grid[i]);
  const NearestPoints nearest(positions);
  std::vector<LeafPoint> points(used.size());
  parallel_for(
      used.size(),
      [&](std::size_t i) {
        LeafPoint& point = points[i];
        const std::vector<std::uint32_t> around = nearest.find(positions[i], kNeighbours + 1);
        std::vector<Vec3> there;
        for (const std::uint32_t k : around) there.push_back(positions[k]);
        point.sphere.center = positions[i];
        const std::size_t third = std::min<std::size_t>(3, there.size() - 1);
        point.sphere.radius = 0.5 * distance(positions[i], there[third]) * 1.4142135623730951;
        if (!mesh.source.normals.empty()) {
          const auto& n = mesh.source.normals[used[i]];
          point.normal = normalized({n[0], n[1], n[2]});
        }
        if (length(point.normal) == 0) point.normal = plane_normal(there);
        if (!mesh.source.colors.empty()) point.color = mesh.source.colors[used[i]];
      },
      256);
  return points;
}

}  // namespace

std::vector<LeafPoint> leaf_points(const TreeMesh& mesh, const std::vector<Vec3>& grid_positions) {
  return mesh.size() > 0 ? points_of_triangles(mesh, grid_positions) : lone_points(mesh, grid_positions);
}

}  // namespace dupin
