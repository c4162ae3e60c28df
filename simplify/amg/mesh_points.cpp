#include <algorithm>
#include <map>
#include <unordered_map>

#include "../../nurbs/mesh_triangles.h"
#include "../point_sources.h"

namespace dupin {
namespace {

std::uint32_t word(const Rgba8& c) {
  return std::uint32_t(c[0]) | std::uint32_t(c[1]) << 8 | std::uint32_t(c[2]) << 16 | 0xff000000U;
}

struct Corner {
  std::uint32_t vertex, face, color;
  std::array<float, 3> normal;
  bool operator==(const Corner&) const = default;
};
struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::uint64_t h = c.vertex;
    const auto mix = [&](std::uint64_t v) { h = (h ^ v) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29; };
    mix(c.face);
    mix(c.color);
    for (const float x : c.normal) mix(static_cast<std::uint64_t>(static_cast<std::int64_t>(x * 1e6F)));
    return h;
  }
};

class MeshSource {
 public:
  MeshSource(const Part& part, SurfacePoints& points) : part_(part), mesh_(part.polygons), points_(points) {
    colored_ = !mesh_.colors.empty() || !mesh_.polygon_colors.empty();
  }

  void run() {
    const std::vector<std::array<float, 3>> normals = corner_normals(mesh_);
    const std::vector<std::uint32_t> triangles = triangulate(mesh_), polygons = triangle_polygons(mesh_);
    std::vector<bool> used(mesh_.positions.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const std::uint32_t corner = triangles[k], vertex = mesh_.corners[corner], polygon = polygons[k / 3];
      used[vertex] = true;
      points_.triangles.push_back(
          point_of({vertex, face_of(polygon), color_of(vertex, polygon), normals[corner]}));
    }
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (!used[v])
        point_of({v, static_cast<std::uint32_t>(part_.faces.size()), color_of(v, ~0U), loose_normal(v)});
  }

 private:
  std::uint32_t face_of(std::size_t polygon) const {
    return static_cast<std::uint32_t>(part_.faces.size()) + mesh_.group_of(polygon);
  }
  std::uint32_t color_of(std::uint32_t vertex, std::uint32_t polygon) const {
    if (!mesh_.colors.empty()) return word(mesh_.colors[vertex]);
    return !mesh_.polygon_colors.empty() && polygon != ~0U ? word(mesh_.polygon_colors[polygon]) : 0;
  }
  std::array<float, 3> loose_normal(std::uint32_t vertex) const {
    const bool by_vertex = mesh_.corner_normals.empty() && mesh_.normals.size() == mesh_.positions.size();
    return by_vertex ? mesh_.normals[vertex] : std::array<float, 3>{};
  }

  std::uint32_t point_of(const Corner& corner) {
    const auto [at, added] = numbers_.emplace(corner, static_cast<std::uint32_t>(points_.size()));
    if (added) {
      points_.positions.push_back(mesh_.positions[corner.vertex]);
      points_.normals.push_back({corner.normal[0], corner.normal[1], corner.normal[2]});
      points_.faces.push_back(corner.face);
      if (colored_) points_.colors.push_back(corner.color);
    }
    return at->second;
  }

  const Part& part_;
  const PolygonMesh& mesh_;
  SurfacePoints& points_;
  bool colored_ = false;
  std::unordered_map<Corner, std::uint32_t, CornerHash> numbers_;
};

/// Halves long edges, each once for all triangles that share its two points.
class Refiner {
 public:
  Refiner(SurfacePoints& points, double longest, std::size_t most)
      : points_(points), longest_(longest), most_(most) {}

  bool run() {
    bool halved = true;
    while (halved) {
      halved = false;
      middles_.clear();
      std::vector<std::uint32_t> next;
      next.reserve(points_.triangles.size());
      for (std::size_t t = 0; t < points_.triangles.size(); t += 3) halved |= split(t, next);
      points_.triangles = std::move(next);
      if (points_.size() > most_) return false;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    if (distance(points_.positions[a], points_.positions[b]) <= longest_) return kNone;
    const auto [lo, hi] = std::minmax(a, b);
    const auto [at, added] =
        middles_.emplace(std::uint64_t(lo) << 32 | hi, static_cast<std::uint32_t>(points_.size()));
    if (added) add_middle(lo, hi);
    return at->second;
  }

  void add_middle(std::uint32_t a, std::uint32_t b) {
    points_.positions.push_back((points_.positions[a] + points_.positions[b]) * 0.5);
    const Vec3 n = points_.normals[a] + points_.normals[b];
    points_.normals.push_back(length(n) > 0 ? normalized(n) : points_.normals[a]);
    points_.faces.push_back(points_.faces[a]);
    if (!points_.colors.empty()) points_.colors.push_back(mixed(points_.colors[a], points_.colors[b]));
  }

  static std::uint32_t mixed(std::uint32_t a, std::uint32_t b) {
    return (a & b) + (((a ^ b) & 0xfefefefeU) >> 1);
  }

  bool split(std::size_t t, std::vector<std::uint32_t>& out) {
    std::array<std::uint32_t, 3> p{points_.triangles[t], points_.triangles[t + 1], points_.triangles[t + 2]};
    std::array<std::uint32_t, 3> m{middle(p[0], p[1]), middle(p[1], p[2]), middle(p[2], p[0])};
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      out.insert(out.end(), {a, b, c});
    };
    const auto count = 3 - std::count(m.begin(), m.end(), kNone);
    if (count == 0) return add(p[0], p[1], p[2]), false;
    // Turned so that with one middle it is the first, and with two the last is none.
    while (count == 1 ? m[0] == kNone : count == 2 && m[2] != kNone) {
      std::rotate(p.begin(), p.begin() + 1, p.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    }
    if (count == 1) {
      add(p[0], m[0], p[2]);
      add(m[0], p[1], p[2]);
    } else if (count == 2) {
      add(m[0], p[1], m[1]);
      add(p[0], m[0], m[1]);
      add(p[0], m[1], p[2]);
    } else {
      add(p[0], m[0], m[2]);
      add(m[0], p[1], m[1]);
      add(m[2], m[1], p[2]);
      add(m[0], m[1], m[2]);
    }
    return true;
  }

  SurfacePoints& points_;
  double longest_;
  std::size_t most_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

}  // namespace

Result<SurfacePoints> mesh_points(const Part& part, double longest, std::size_t most) {
  SurfacePoints points;
  MeshSource(part, points).run();
  if (points.size() > most || (longest > 0 && !Refiner(points, longest, most).run()))
    return {StatusCode::limit, "more points than one decomposition can take"};
  return points;
}

void append(const SurfacePoints& from, SurfacePoints& to) {
  const std::size_t before = to.size();
  const auto join = [&](auto& list, const auto& other, const auto& none) {
    if (list.empty() && other.empty()) return;
    list.resize(before, none);
    list.insert(list.end(), other.begin(), other.end());
    list.resize(before + from.size(), none);
  };
  join(to.normals, from.normals, Vec3{});
  join(to.colors, from.colors, 0U);
  join(to.faces, from.faces, 0U);
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  for (const std::uint32_t i : from.triangles) to.triangles.push_back(static_cast<std::uint32_t>(before) + i);
}

}  // namespace dupin
