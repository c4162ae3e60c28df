#include "fan_triangles.h"

#include <algorithm>
#include <limits>

namespace dupin::amg {
namespace {

class Collector {
 public:
  Collector(const UniquePoints& points, const Neighborhoods& around)
      : points_(points), around_(around), fan_of_(points.positions.size(), kNone) {
    for (std::uint32_t f = 0; f < points.loose.size(); ++f) fan_of_[points.loose[f]] = f;
  }

  FanTriangles run() {
    for (std::uint32_t f = 0; f < points_.loose.size(); ++f) add_fan(f);
    mark_rim();
    return std::move(result_);
  }

 private:
  static constexpr double kNeedle = 1e-6;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Calls with each pair of points that follow each other around the fan's.
  template <class What>
  void each_side(std::uint32_t f, const What& what) const {
    const Fans& fans = around_.fans;
    const std::uint64_t begin = fans.first[f], count = fans.first[f + 1] - begin;
    for (std::uint64_t k = 0; k + (fans.closed[f] ? 0 : 1) < count; ++k)
      what(fans.points[begin + k], fans.points[begin + (k + 1) % count]);
  }

  bool fan_has(std::uint32_t point, std::uint32_t a, std::uint32_t b) const {
    bool has = false;
    if (fan_of_[point] != kNone)
      each_side(fan_of_[point],
                [&](std::uint32_t p, std::uint32_t q) { has |= (p == a && q == b) || (p == b && q == a); });
    return has;
  }

  /// Three points in a line are no surface.
  bool is_needle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec3 ab = points_.positions[b] - points_.positions[a],
               ac = points_.positions[c] - points_.positions[a];
    return length(cross(ab, ac)) <= kNeedle * std::max(dot(ab, ab), dot(ac, ac));
  }

  void add_fan(std::uint32_t f) {
    const std::uint32_t i = points_.loose[f];
    each_side(f, [&](std::uint32_t a, std::uint32_t b) {
      if (!together(points_, around_, i, a) || !together(points_, around_, i, b) ||
          !together(points_, around_, a, b))
        return;
      if (is_needle(i, a, b)) return;
      // Of the fans that have it, that of the least point gives it.
      if (a < i && fan_has(a, i, b)) return;
      if (b < i && fan_has(b, i, a)) return;
      result_.triangles.insert(result_.triangles.end(), {i, a, b});
    });
  }

  void mark_rim() {
    struct Edge {
      std::uint32_t a, b;
      bool operator<(const Edge& o) const { return a != o.a ? a < o.a : b < o.b; }
      bool operator==(const Edge&) const = default;
    };
    std::vector<Edge> edges;
    edges.reserve(result_.triangles.size());
    result_.rim.assign(points_.positions.size(), false);
    for (const std::uint32_t i : points_.loose) result_.rim[i] = true;
    for (std::size_t t = 0; t < result_.triangles.size(); t += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(result_.triangles[t + k], result_.triangles[t + (k + 1) % 3]);
        edges.push_back({a, b});
        result_.rim[a] = false;
      }
    for (const Edge& e : edges) result_.rim[e.b] = false;
    std::sort(edges.begin(), edges.end());
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
      for (end = begin + 1; end < edges.size() && edges[end] == edges[begin];) ++end;
      if (end == begin + 1) result_.rim[edges[begin].a] = result_.rim[edges[begin].b] = true;
    }
  }

  const UniquePoints& points_;
  const Neighborhoods& around_;
  std::vector<std::uint32_t> fan_of_;
  FanTriangles result_;
};

}  // namespace

FanTriangles fan_triangles(const UniquePoints& points, const Neighborhoods& around) {
  return Collector(points, around).run();
}

}  // namespace dupin::amg
