#include "mesh_triangles.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr std::size_t kGrain = 4096;

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Vec3 to_double(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}
bool is_zero(const std::array<float, 3>& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

// ---- triangulation

/// Cuts one polygon's ears in the coordinate plane in which its area is largest.
class EarCutter {
 public:
  EarCutter(const PolygonMesh& mesh, std::size_t polygon) {
    const Vec3 n = area_vector(mesh, polygon);
    const int drop = std::abs(n.x) >= std::abs(n.y) && std::abs(n.x) >= std::abs(n.z) ? 0
                     : std::abs(n.y) >= std::abs(n.z)                                 ? 1
                                                                                      : 2;
    const int x = (drop + 1) % 3, y = (drop + 2) % 3;
    const double side = n[drop] < 0 ? -1 : 1;
    for (const std::uint32_t v : mesh.polygon(polygon))
      points_.push_back({mesh.positions[v][x], side * mesh.positions[v][y]});
  }

  /// A doubled point may hide a turn.
  bool is_convex() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i)
      if (points_[i] == points_[(i + 1) % n] || turn(i, (i + 1) % n, (i + 2) % n) < 0) return false;
    return true;
  }

  /// Writes n − 2 triangles of indices into the polygon.
  void cut(std::uint32_t first_corner, std::uint32_t* out) {
    std::vector<std::uint32_t> ring(points_.size());
    std::iota(ring.begin(), ring.end(), 0U);
    long tests = static_cast<long>(kEarTests) * static_cast<long>(ring.size());
    std::size_t at = 0, misses = 0;
    while (ring.size() > 3 && misses < ring.size() && tests > 0) {
      const std::size_t n = ring.size();
      const std::uint32_t a = ring[(at + n - 1) % n], b = ring[at % n], c = ring[(at + 1) % n];
      if (is_ear(ring, a, b, c, tests)) {
        for (const std::uint32_t i : {a, b, c}) *out++ = first_corner + i;
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at % n));
        misses = 0;
        at = at % n;
      } else {
        ++misses, ++at;
      }
      if (at >= ring.size()) at = 0;
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      for (const std::uint32_t k : {ring[0], ring[i], ring[i + 1]}) *out++ = first_corner + k;
  }

 private:
  double turn(std::size_t a, std::size_t b, std::size_t c) const {
    return cross(points_[b] - points_[a], points_[c] - points_[a]);
  }
  bool is_ear(const std::vector<std::uint32_t>& ring, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              long& tests) const {
    if (points_[b] == points_[a] || points_[b] == points_[c]) return true;  // cuts nothing off
    if (!(turn(a, b, c) > 0)) return false;
    tests -= static_cast<long>(ring.size());
    for (const std::uint32_t p : ring) {
      if (p == a || p == b || p == c || points_[p] == points_[a] || points_[p] == points_[b] ||
          points_[p] == points_[c])
        continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }
  std::vector<Vec2> points_;
};

void cut_polygon(const PolygonMesh& mesh, std::size_t polygon, std::uint32_t* out) {
  const auto first = static_cast<std::uint32_t>(mesh.first_corner(polygon));
  const auto n = static_cast<std::uint32_t>(mesh.corner_count(polygon));
  if (n > 3) {
    EarCutter cutter(mesh, polygon);
    if (!cutter.is_convex()) return cutter.cut(first, out);
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i)
    for (const std::uint32_t k : {0U, i, i + 1}) *out++ = first + k;
}

// ---- normals

/// The corners around each vertex, in their order.
struct Incidence {
  std::vector<std::uint32_t> starts, corners;
  explicit Incidence(const PolygonMesh& mesh)
      : starts(mesh.positions.size() + 1, 0), corners(mesh.corners.size()) {
    for (const std::uint32_t v : mesh.corners) ++starts[v + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for (std::uint32_t c = 0; c < mesh.corners.size(); ++c) corners[next[mesh.corners[c]]++] = c;
  }
};

struct WeightedNormal {
  Vec3 unit;
  double angle = 0;
};

/// Of every corner, its polygon's normal and angle there.
std::vector<WeightedNormal> polygon_normals(const PolygonMesh& mesh) {
  std::vector<WeightedNormal> result(mesh.corners.size());
  parallel_for(
      mesh.polygon_count(),
      [&](std::size_t i) {
        const Vec3 n = normalized(area_vector(mesh, i));
        const auto polygon = mesh.polygon(i);
        const std::size_t first = mesh.first_corner(i), count = polygon.size();
        for (std::size_t k = 0; k < count; ++k) {
          const Vec3 at = mesh.positions[polygon[k]];
          const Vec3 next = mesh.positions[polygon[(k + 1) % count]] - at;
          const Vec3 last = mesh.positions[polygon[(k + count - 1) % count]] - at;
          result[first + k] = {n, std::atan2(length(cross(next, last)), dot(next, last))};
        }
      },
      kGrain);
  return result;
}

/// Smooth normals at one vertex. Around a vertex of so many polygons that looking at every pair would take
/// long, the polygons are put into a few clusters instead.
class VertexNormals {
 public:
  VertexNormals(std::span<const std::uint32_t> corners, const std::vector<WeightedNormal>& around,
                std::vector<std::array<float, 3>>& out)
      : corners_(corners), around_(around), out_(out) {}

  void run() {
    if (corners_.size() <= kMostPairs)
      by_pairs();
    else
      by_clusters();
  }

 private:
  static constexpr std::size_t kMostPairs = 32, kMostClusters = 16;

  static double least_cosine() {
    static const double kCosine = std::cos(kCreaseDegrees * std::numbers::pi / 180);
    return kCosine;
  }

  void by_pairs() {
    for (const std::uint32_t c : corners_) {
      const Vec3& own = around_[c].unit;
      const bool degenerate = length(own) == 0;
      Vec3 sum;
      for (const std::uint32_t k : corners_)
        if (degenerate || dot(around_[k].unit, own) >= least_cosine())
          sum += around_[k].unit * around_[k].angle;
      out_[c] = to_float(normalized(sum));
    }
  }

  void by_clusters() {
    std::vector<Vec3> first, sum;
    std::vector<std::size_t> cluster(corners_.size());
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const WeightedNormal& w = around_[corners_[i]];
      std::size_t k = 0;
      while (k < first.size() && !(dot(first[k], w.unit) >= least_cosine())) ++k;
      if (k == first.size() && k < kMostClusters) first.push_back(w.unit), sum.emplace_back();
      cluster[i] = std::min(k, first.size() - 1);
      sum[cluster[i]] += w.unit * w.angle;
    }
    for (std::size_t i = 0; i < corners_.size(); ++i)
      out_[corners_[i]] = to_float(normalized(sum[cluster[i]]));
  }

  std::span<const std::uint32_t> corners_;
  const std::vector<WeightedNormal>& around_;
  std::vector<std::array<float, 3>>& out_;
};

/// The file's normal of a corner, or zero.
std::array<float, 3> given_normal(const PolygonMesh& mesh, std::size_t corner) {
  if (mesh.normals.empty()) return {};
  if (mesh.corner_normals.empty()) return mesh.normals[mesh.corners[corner]];
  const std::uint32_t i = mesh.corner_normals[corner];
  return i == PolygonMesh::kNoNormal ? std::array<float, 3>{} : mesh.normals[i];
}

bool has_all_normals(const PolygonMesh& mesh) {
  for (std::size_t c = 0; c < mesh.corners.size(); ++c)
    if (is_zero(given_normal(mesh, c))) return false;
  return true;
}

/// For each corner its vertex in the drawn mesh, and what that is made of.
struct SplitVertices {
  std::vector<std::uint32_t> of_corner, corner_of;

  SplitVertices(const PolygonMesh& mesh, const std::vector<std::array<float, 3>>& normals)
      : of_corner(mesh.corners.size()) {
    const Incidence incidence(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const auto first = static_cast<std::uint32_t>(corner_of.size());
      for (std::uint32_t i = incidence.starts[v]; i < incidence.starts[v + 1]; ++i)
        of_corner[incidence.corners[i]] = find(incidence.corners[i], first, normals);
    }
  }

 private:
  static constexpr std::uint32_t kMostTried = 64;  ///< of a vertex's own before a double is taken
  std::uint32_t find(std::uint32_t corner, std::uint32_t first,
                     const std::vector<std::array<float, 3>>& normals) {
    const auto last = static_cast<std::uint32_t>(corner_of.size());
    for (std::uint32_t k = last; k > first && last - k < kMostTried; --k)
      if (normals[corner_of[k - 1]] == normals[corner]) return k - 1;
    corner_of.push_back(corner);
    return last;
  }
};

}  // namespace

Vec3 area_vector(const PolygonMesh& mesh, std::size_t polygon) {
  const auto p = mesh.polygon(polygon);
  const Vec3 origin = mesh.positions[p[0]];
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < p.size(); ++i)
    sum += cross(mesh.positions[p[i]] - origin, mesh.positions[p[i + 1]] - origin);
  return sum;
}

std::vector<std::uint32_t> triangulate(const PolygonMesh& mesh) {
  std::vector<std::uint32_t> result(3 * triangle_count(mesh));
  if (mesh.all_triangles()) {
    std::iota(result.begin(), result.end(), 0U);
    return result;
  }
  parallel_for(
      mesh.polygon_count(),
      // The polygons before this one have made all their corners' number of triangles but two each.
      [&](std::size_t i) { cut_polygon(mesh, i, result.data() + 3 * (mesh.first_corner(i) - 2 * i)); }, 1024);
  return result;
}

std::vector<std::uint32_t> triangle_polygons(const PolygonMesh& mesh) {
  std::vector<std::uint32_t> result;
  result.reserve(triangle_count(mesh));
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i)
    result.insert(result.end(), mesh.corner_count(i) - 2, static_cast<std::uint32_t>(i));
  return result;
}

std::vector<std::array<float, 3>> corner_normals(const PolygonMesh& mesh) {
  std::vector<std::array<float, 3>> result(mesh.corners.size());
  if (!has_all_normals(mesh)) {
    const Incidence incidence(mesh);
    const std::vector<WeightedNormal> around = polygon_normals(mesh);
    parallel_for(
        mesh.positions.size(),
        [&](std::size_t v) {
          const std::uint32_t first = incidence.starts[v], last = incidence.starts[v + 1];
          if (first < last)
            VertexNormals({incidence.corners.data() + first, last - first}, around, result).run();
        },
        kGrain);
  }
  parallel_for(
      mesh.corners.size(),
      [&](std::size_t c) {
        const std::array<float, 3> given = given_normal(mesh, c);
        if (!is_zero(given)) result[c] = to_float(normalized(to_double(given)));
      },
      kGrain);
  return result;
}

TriangleMesh to_triangle_mesh(const PolygonMesh& mesh, const Vec3& origin) {
  TriangleMesh out;
  out.origin = origin;
  const std::vector<std::array<float, 3>> normals = corner_normals(mesh);
  const SplitVertices split(mesh, normals);
  for (const std::uint32_t c : split.corner_of) {
    out.positions.push_back(to_float(mesh.positions[mesh.corners[c]] - origin));
    out.normals.push_back(normals[c]);
  }
  out.triangles = triangulate(mesh);
  for (std::uint32_t& c : out.triangles) c = split.of_corner[c];
  out.faces.reserve(out.triangles.size() / 3);
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i)
    out.faces.insert(out.faces.end(), mesh.corner_count(i) - 2, mesh.group_of(i));
  return out;
}

}  // namespace dupin
