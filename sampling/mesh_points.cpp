#include "mesh_points.h"

#include <bit>
#include <unordered_map>

#include "../core/parallel.h"
#include "../nurbs/mesh_triangles.h"

namespace dupin {
namespace {

constexpr double kDegrees = 3.14159265358979323846 / 180;
/// Rectangles reach this many times the distance of the osculating circle farther, but not more than this
/// part.
constexpr double kSlant = 2, kMostSlant = 0.5;

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    std::size_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0x9e3779b97f4a7c15ULL;
    return h ^ h >> 29;
  }
};

/// Of each vertex the first one at its place.
std::vector<std::uint32_t> welded(const std::vector<Vec3>& positions) {
  std::unordered_map<Vec3, std::uint32_t, PositionHash> first;
  first.reserve(positions.size());
  std::vector<std::uint32_t> weld(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i)
    weld[i] = first.try_emplace(positions[i] + Vec3{}, i).first->second;
  return weld;
}

struct Triangle {
  std::array<std::uint32_t, 3> vertices;
  Vec3 normal;  ///< unit
  double area;
  std::uint32_t group;
};

std::vector<Triangle> triangles_of(const PolygonMesh& mesh, const std::vector<std::uint32_t>& weld,
                                   MeshPointLosses& losses) {
  const std::vector<std::uint32_t> corners = triangulate(mesh), polygons = triangle_polygons(mesh);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < corners.size() / 3; ++i) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) t.vertices[k] = weld[mesh.corners[corners[3 * i + k]]];
    const Vec3& a = mesh.positions[t.vertices[0]];
    const Vec3 doubled = cross(mesh.positions[t.vertices[1]] - a, mesh.positions[t.vertices[2]] - a);
    t.area = length(doubled) / 2;
    t.normal = normalized(doubled);
    t.group = mesh.group_of(polygons[i]);
    if (t.area > 0 && std::isfinite(t.area)) triangles.push_back(t);
  }
  losses.flat_triangles = corners.size() / 3 - triangles.size();
  return triangles;
}

/// Corner c is corner c % 3 of triangle c / 3.
struct Star {
  std::vector<std::uint32_t> first;    ///< of each vertex in `corners`, and their number
  std::vector<std::uint32_t> corners;  ///< around each vertex
};
Star make_star(const std::vector<Triangle>& triangles, std::size_t vertices) {
  Star star;
  star.first.assign(vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t.vertices) ++star.first[v + 1];
  for (std::size_t v = 0; v < vertices; ++v) star.first[v + 1] += star.first[v];
  star.corners.resize(3 * triangles.size());
  std::vector<std::uint32_t> next(star.first.begin(), star.first.end() - 1);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) star.corners[next[triangles[i].vertices[k]]++] = 3 * i + k;
  return star;
}

/// Taubin's tensor of a fan in a tangent basis, and the rectangle that its edges and triangles need.
class Fan {
 public:
  Fan(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
      std::span<const std::uint32_t> corners)
      : positions_(positions), triangles_(triangles), corners_(corners) {}

  DifferentialPoint point(const MeshPointOptions& options) {
    DifferentialPoint p;
    const Triangle& first = triangles_[corners_[0] / 3];
    p.position = positions_[first.vertices[corners_[0] % 3]];
    Vec3 normal;
    for (const std::uint32_t c : corners_) normal += triangles_[c / 3].normal * triangles_[c / 3].area;
    normal = normalized(normal);
    find_edges();
    const Curvature curvature = principal(p.position, normal, options.curvature);
    p.u = curvature.d1;
    p.v = curvature.d2;
    p.lambda_u = curvature.k1;
    p.lambda_v = curvature.k2;
    set_extents(p, options.epsilon, options.delta);
    enlarge(p, options.hold_centroids);
    return p;
  }

 private:
  /// To another vertex, with what the fan's triangles at it are.
  struct Spoke {
    std::uint32_t vertex;
    double area;
    Vec3 normals;
  };

  void find_edges() {
    for (const std::uint32_t c : corners_) {
      const Triangle& t = triangles_[c / 3];
      for (const std::uint32_t k : {1U, 2U})
        spokes_.push_back({t.vertices[(c % 3 + k) % 3], t.area, t.normal});
    }
    std::stable_sort(spokes_.begin(), spokes_.end(),
                     [](const Spoke& a, const Spoke& b) { return a.vertex < b.vertex; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
      if (i == 0 || spokes_[i].vertex != spokes_[kept - 1].vertex) {
        spokes_[kept++] = spokes_[i];
      } else {
        spokes_[kept - 1].area += spokes_[i].area;
        spokes_[kept - 1].normals += spokes_[i].normals;
      }
    }
    spokes_.resize(kept);
  }

  /// The symmetric tensor (w11, w12, w22) in a tangent basis.
  using Tensor = std::array<double, 3>;
  /// An edge's direction in the basis, its normal curvature and its weight.
  struct Measure {
    double c, s, curvature, weight;
  };

  Curvature principal(const Vec3& center, const Vec3& n, MeshCurvature how) const {
    const Vec3 e1 = any_perpendicular(n), e2 = cross(n, e1);
    std::vector<Measure> measures;
    for (const Spoke& s : spokes_) {
      const Vec3 d = positions_[s.vertex] - center;
      const Vec2 flat{dot(d, e1), dot(d, e2)};
      const double l = length(flat), d2 = dot(d, d);
      // An edge along the normal has no direction.
      if (l > 1e-12 * std::sqrt(d2)) measures.push_back({flat.x / l, flat.y / l, 2 * dot(n, d) / d2, s.area});
    }
    Tensor w = taubin(measures);
    if (how == MeshCurvature::fitted) fit(measures, w);
    SurfaceJet jet;
    jet.pu = e1;
    jet.pv = e2;
    jet.puu = n * w[0];
    jet.puv = n * w[1];
    jet.pvv = n * w[2];
    return principal_curvature(jet);
  }

  /// M = Σ w κ T Tᵀ, Σ w = 1, has the principal directions, and eigenvalues m, m' from which κ = 3m − m': as
  /// a matrix that is 4M − tr(M).
  static Tensor taubin(const std::vector<Measure>& measures) {
    double m11 = 0, m12 = 0, m22 = 0, weights = 0;
    for (const Measure& m : measures) {
      weights += m.weight;
      m11 += m.weight * m.curvature * m.c * m.c;
      m12 += m.weight * m.curvature * m.c * m.s;
      m22 += m.weight * m.curvature * m.s * m.s;
    }
    const double scale = weights > 0 ? 1 / weights : 0, trace = m11 + m22;
    return {scale * (4 * m11 - trace), scale * 4 * m12, scale * (4 * m22 - trace)};
  }

  /// Least Σ w (Tᵀ W T − κ)²; leaves W alone where the directions do not determine it.
  static void fit(const std::vector<Measure>& measures, Tensor& w) {
    Vec3 x, y, z, right;  // the normal equations, by columns
    for (const Measure& m : measures) {
      const Vec3 row{m.c * m.c, 2 * m.c * m.s, m.s * m.s};
      x += row * (m.weight * row.x);
      y += row * (m.weight * row.y);
      z += row * (m.weight * row.z);
      right += row * (m.weight * m.curvature);
    }
    const Mat3 normal{x, y, z};
    const double trace = x.x + y.y + z.z, size = determinant(normal);
    if (!(size > 1e-6 * trace * trace * trace)) return;
    const Vec3 solved = inverse(normal) * right;
    w = {solved.x, solved.y, solved.z};
  }

  static void reach(const DifferentialPoint& p, const Vec3& to, const Vec3& along, Vec2& half) {
    const Vec3 n = p.n(), d = to - p.position;
    const double slant = dot(along, n);
    const Vec3 flat = slant > 0.1 * length(along) ? d - along * (dot(d, n) / slant) : d;
    half = {std::max(half.x, std::abs(dot(flat, p.u))), std::max(half.y, std::abs(dot(flat, p.v)))};
  }

  void enlarge(DifferentialPoint& p, bool hold_centroids) const {
    Vec2 half;
    for (const Spoke& s : spokes_) reach(p, (p.position + positions_[s.vertex]) * 0.5, s.normals, half);
    for (const std::uint32_t c : corners_) {
      if (!hold_centroids) break;
      const Triangle& t = triangles_[c / 3];
      reach(p, (positions_[t.vertices[0]] + positions_[t.vertices[1]] + positions_[t.vertices[2]]) / 3,
            t.normal, half);
    }
    if (hold_centroids) {
      // As seen at a slant; see adaptive_points.cpp.
      half.x += std::min(kSlant * sagitta(p.lambda_u, half.x), kMostSlant * half.x);
      half.y += std::min(kSlant * sagitta(p.lambda_v, half.y), kMostSlant * half.y);
    }
    // A sliver's edges may all lie along one direction, but for rounding.
    const double least = 1e-3 * std::max(half.x, half.y);
    half = {std::max(half.x, least), std::max(half.y, least)};
    p.own_size = half.x > p.half_u || half.y > p.half_v;
    p.half_u = std::max(p.half_u, half.x);
    p.half_v = std::max(p.half_v, half.y);
    if (p.own_size) p.bound = std::max(sagitta(p.lambda_u, p.half_u), sagitta(p.lambda_v, p.half_v));
  }

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  std::span<const std::uint32_t> corners_;
  std::vector<Spoke> spokes_;
};

/// The corners around a vertex as sets that grow together.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = i;
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Sorts the corners around a vertex into smooth fans: triangles that share an edge there, run along it in
/// opposite directions, and meet at less than a crease's angle. Returns where each fan ends.
std::vector<std::size_t> split_into_fans(const std::vector<Triangle>& triangles,
                                         std::span<std::uint32_t> corners) {
  static const double kLeastCosine = std::cos(kCreaseDegrees * kDegrees);
  /// An edge may have more triangles; of those only so many neighbours are looked at.
  constexpr std::size_t kMostPairs = 64;
  struct Side {
    std::uint32_t vertex;
    bool leaves;
    std::size_t corner;
  };
  std::vector<Side> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& vertices = triangles[corners[i] / 3].vertices;
    sides.push_back({vertices[(corners[i] % 3 + 1) % 3], true, i});
    sides.push_back({vertices[(corners[i] % 3 + 2) % 3], false, i});
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.vertex < b.vertex; });
  Sets sets(corners.size());
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t k = i + 1;
         k < std::min(sides.size(), i + kMostPairs) && sides[k].vertex == sides[i].vertex; ++k) {
      const Vec3 &a = triangles[corners[sides[i].corner] / 3].normal,
                 &b = triangles[corners[sides[k].corner] / 3].normal;
      if (sides[i].leaves != sides[k].leaves && dot(a, b) > kLeastCosine)
        sets.join(sides[i].corner, sides[k].corner);
    }
  std::vector<std::pair<std::size_t, std::uint32_t>> by_set;
  for (std::size_t i = 0; i < corners.size(); ++i) by_set.push_back({sets.find(i), corners[i]});
  std::stable_sort(by_set.begin(), by_set.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < by_set.size(); ++i) {
    corners[i] = by_set[i].second;
    if (i + 1 == by_set.size() || by_set[i + 1].first != by_set[i].first) ends.push_back(i + 1);
  }
  return ends;
}

}  // namespace

MeshPointOptions papers_mesh_options() {
  MeshPointOptions options;
  options.curvature = MeshCurvature::taubin;
  options.split_creases = options.hold_centroids = false;
  return options;
}

PartPoints mesh_points(const PolygonMesh& mesh, const MeshPointOptions& options, MeshPointLosses& losses) {
  const std::vector<std::uint32_t> weld = welded(mesh.positions);
  const std::vector<Triangle> triangles = triangles_of(mesh, weld, losses);
  Star star = make_star(triangles, mesh.positions.size());
  std::vector<std::vector<std::size_t>> ends(mesh.positions.size());
  const auto around = [&](std::size_t v) {
    return std::span(star.corners).subspan(star.first[v], star.first[v + 1] - star.first[v]);
  };
  parallel_for(
      ends.size(),
      [&](std::size_t v) {
        if (options.split_creases) ends[v] = split_into_fans(triangles, around(v));
        if (!options.split_creases && !around(v).empty()) ends[v] = {around(v).size()};
      },
      1024);
  std::vector<std::uint32_t> first_point(ends.size() + 1, 0);
  for (std::size_t v = 0; v < ends.size(); ++v) {
    first_point[v + 1] = first_point[v] + static_cast<std::uint32_t>(ends[v].size());
    losses.split_vertices += ends[v].size() > 1;
  }
  PartPoints out;
  out.points.resize(first_point.back());
  std::vector<std::uint32_t> point_of(star.corners.size());  // of each corner
  parallel_for(
      ends.size(),
      [&](std::size_t v) {
        std::size_t begin = 0;
        for (std::size_t f = 0; f < ends[v].size(); ++f) {
          const auto fan = around(v).subspan(begin, ends[v][f] - begin);
          const std::uint32_t index = first_point[v] + static_cast<std::uint32_t>(f);
          out.points[index] = Fan(mesh.positions, triangles, fan).point(options);
          out.points[index].face = options.first_face + triangles[fan[0] / 3].group;
          for (const std::uint32_t c : fan) point_of[c] = index;
          begin = ends[v][f];
        }
      },
      256);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = point_of[3 * i + k], b = point_of[3 * i + (k + 1) % 3];
      out.edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(out.edges.begin(), out.edges.end());
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  losses.loose_vertices = loose_point_count(mesh);
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t v : mesh.corners) used[v] = true;
  for (std::size_t v = 0; v < used.size(); ++v) losses.lost_vertices += used[v] && ends[weld[v]].empty();
  return out;
}

}  // namespace dupin
