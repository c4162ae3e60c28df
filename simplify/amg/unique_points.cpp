#include "unique_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../../core/parallel.h"

namespace dupin::amg {
namespace {

constexpr std::size_t kGrain = 4096;

/// Every third bit of the result, from the lowest on, is a bit of x; 21 bits of it.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  x = (x | x << 2) & 0x1249249249249249ULL;
  return x;
}

struct Cell {
  std::uint64_t key = 0;  ///< along Morton's curve, by the upper 21 bits of each coordinate
  std::array<std::uint32_t, 3> at{};
  std::uint32_t point = 0;
  bool same_place(const Cell& o) const { return key == o.key && at == o.at; }
  bool operator<(const Cell& o) const {
    return key != o.key ? key < o.key : at != o.at ? at < o.at : point < o.point;
  }
};

std::vector<Cell> cells_along_curve(const std::vector<Vec3>& positions, const Box3& box, double extent) {
  std::vector<Cell> cells(positions.size());
  parallel_for(
      positions.size(),
      [&](std::size_t i) {
        const Vec3 p = extent > 0 ? (positions[i] - box.lo) / extent / kMergeFraction : Vec3{};
        Cell& cell = cells[i];
        cell.at = {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                   static_cast<std::uint32_t>(p.z)};
        cell.key = spread_bits(cell.at[0] >> 10) | spread_bits(cell.at[1] >> 10) << 1 |
                   spread_bits(cell.at[2] >> 10) << 2;
        cell.point = static_cast<std::uint32_t>(i);
      },
      kGrain);
  std::sort(cells.begin(), cells.end());
  return cells;
}

Vec3 unit_or_zero(const Vec3& v) {
  const double l = length(v);
  return l > 0 ? v / l : Vec3{};
}

class Merger {
 public:
  Merger(const SurfacePoints& points, UniquePoints& unique, const Vec3& middle)
      : points_(points), unique_(unique), middle_(middle) {}

  /// The points of one cell.
  void add(const Cell* begin, const Cell* end) {
    const std::size_t first = unique_.positions.size();
    for (const Cell* cell = begin; cell != end; ++cell) {
      const Vec3 normal = points_.normals.empty() ? Vec3{} : points_.normals[cell->point];
      std::size_t at = first;
      while (at < unique_.positions.size() && !mergeable(at, normal)) ++at;
      if (at == unique_.positions.size()) {
        unique_.positions.push_back(place(points_.positions[cell->point]));
        if (!points_.normals.empty()) unique_.normals.push_back({});
      }
      if (!points_.normals.empty()) unique_.normals[at] += normal;
      unique_.unique_of[cell->point] = static_cast<std::uint32_t>(at);
    }
  }

 private:
  Vec3 place(const Vec3& p) const { return unique_.extent > 0 ? (p - middle_) / unique_.extent : Vec3{}; }
  bool mergeable(std::size_t at, const Vec3& normal) const {
    return points_.is_mesh() || points_.normals.empty() ||
           same_sheet(unit_or_zero(unique_.normals[at]), normal);
  }
  const SurfacePoints& points_;
  UniquePoints& unique_;
  Vec3 middle_;
};

void keep_triangles(const SurfacePoints& points, UniquePoints& unique) {
  std::vector<bool> used(unique.positions.size());
  for (std::size_t t = 0; t < points.triangles.size(); t += 3) {
    const std::uint32_t a = unique.unique_of[points.triangles[t]],
                        b = unique.unique_of[points.triangles[t + 1]],
                        c = unique.unique_of[points.triangles[t + 2]];
    if (a == b || b == c || c == a) continue;
    unique.triangles.insert(unique.triangles.end(), {a, b, c});
    used[a] = used[b] = used[c] = true;
  }
  for (std::uint32_t i = 0; i < used.size(); ++i)
    if (!used[i]) unique.loose.push_back(i);
}

}  // namespace

UniquePoints unique_points(const SurfacePoints& points) {
  UniquePoints unique;
  Box3 box;
  for (const Vec3& p : points.positions) box.add(p);
  if (box.empty()) return unique;
  const Vec3 size = box.size();
  unique.extent = std::max({size.x, size.y, size.z});
  if (!std::isfinite(unique.extent) || !std::isnormal(unique.extent)) unique.extent = 0;
  const std::vector<Cell> cells = cells_along_curve(points.positions, box, unique.extent);
  unique.unique_of.resize(points.size());
  Merger merger(points, unique, box.center());
  for (std::size_t begin = 0, end; begin < cells.size(); begin = end) {
    for (end = begin + 1; end < cells.size() && cells[end].same_place(cells[begin]);) ++end;
    merger.add(&cells[begin], cells.data() + end);
  }
  for (Vec3& n : unique.normals) n = unit_or_zero(n);
  keep_triangles(points, unique);
  return unique;
}

}  // namespace dupin::amg
