// The end of a crease within a surface. OpenSubdiv's limit masks take such a vertex for a smooth one, which
// is off by what the crease pulls at its ring; here its ring is subdivided until it has shrunk into the
// limit.
#include <algorithm>
#include <cmath>
#include <optional>

#include "cage_levels.h"

namespace dupin {
namespace {

/// A dart vertex and its neighbours against the clock: edge points from the crease's on, and for quads the
/// face points between them.
struct Ring {
  Vec3 centre;
  std::vector<Vec3> edges, faces;
};

std::optional<Ring> ring_of(const CageLevel& level, std::uint32_t first_face, std::uint32_t vertex,
                            bool triangles) {
  // From any face back to the crease, then around to it again.
  const auto corner = [&](std::uint32_t face) {
    const auto vertices = level.vertices(face);
    return static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin());
  };
  const auto over = [&](std::uint32_t face, std::uint32_t edge) {
    const auto& faces = level.edge_faces[edge];
    return faces[0] == kNoIndex ? kNoIndex : faces[0] == face ? faces[1] : faces[0];
  };
  constexpr int kMost = 1 << 16;
  std::uint32_t face = first_face;
  for (int i = 0; i < kMost; ++i) {
    const std::uint32_t before = over(face, level.edges(face)[corner(face)]);
    if (before == kNoIndex) break;
    if (before == first_face) return std::nullopt;
    face = before;
  }
  const std::uint32_t crease = level.edges(face)[corner(face)];
  Ring ring{level.points[vertex], {}, {}};
  for (int i = 0; i < kMost && face != kNoIndex; ++i) {
    const auto vertices = level.vertices(face);
    const std::size_t c = corner(face), n = vertices.size();
    if (n != (triangles ? 3u : 4u)) return std::nullopt;
    ring.edges.push_back(level.points[vertices[(c + 1) % n]]);
    if (!triangles) ring.faces.push_back(level.points[vertices[(c + 2) % n]]);
    const std::uint32_t last = level.edges(face)[(c + n - 1) % n];
    face = over(face, last);
    if (face == kNoIndex && last != crease) return std::nullopt;
  }
  return ring.edges.size() >= 2 ? std::optional(ring) : std::nullopt;
}

Vec3 sum(const std::vector<Vec3>& points) {
  Vec3 total;
  for (const Vec3& p : points) total += p;
  return total;
}

Ring subdivided(const Ring& r) {
  const std::size_t count = r.edges.size();
  const auto n = static_cast<double>(count);
  const bool triangles = r.faces.empty();
  Ring out = r;
  if (triangles) {
    const double c = 3.0 / 8 + std::cos(2 * 3.14159265358979323846 / n) / 4, beta = (5.0 / 8 - c * c) / n;
    out.centre = r.centre * (1 - n * beta) + sum(r.edges) * beta;
  } else {
    out.centre =
        r.centre * (1 - 7 / (4 * n)) + sum(r.edges) * (3 / (2 * n * n)) + sum(r.faces) * (1 / (4 * n * n));
  }
  out.edges[0] = (r.centre + r.edges[0]) * 0.5;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count, before = (i + count - 1) % count;
    if (!triangles) out.faces[i] = (r.centre + r.edges[i] + r.faces[i] + r.edges[next]) * 0.25;
    if (i == 0) continue;
    const Vec3 sides = r.edges[next] + r.edges[before];
    out.edges[i] =
        triangles ? (r.centre + r.edges[i]) * (3.0 / 8) + sides * (1.0 / 8)
                  : (r.centre + r.edges[i]) * (3.0 / 8) + (sides + r.faces[i] + r.faces[before]) * (1.0 / 16);
  }
  return out;
}

struct DartLimit {
  Vec3 point, tangent_u, tangent_v;
};

/// Around the centre the ring shrinks to nothing, and is blown up again so that its shape, an affine image of
/// one that is flat, comes out.
DartLimit limit_of(Ring ring) {
  constexpr int kSteps = 150;
  Vec3 limit = ring.centre;
  double scale = 1;
  for (int step = 0; step < kSteps; ++step) {
    Ring next = subdivided(ring);
    const Vec3 moved = next.centre - ring.centre;
    limit += moved * scale;
    double size = 0;
    for (Vec3& e : next.edges) e = e - next.centre, size = std::max(size, length(e));
    for (Vec3& f : next.faces) f = f - next.centre;
    if (!(size > 0)) break;
    next.centre = {};
    for (Vec3& e : next.edges) e = e / size;
    for (Vec3& f : next.faces) f = f / size;
    scale *= size;
    ring = next;
  }
  Vec3 n;
  for (std::size_t i = 0; i < ring.edges.size(); ++i)
    n += cross(ring.edges[i], ring.edges[(i + 1) % ring.edges.size()]);
  const Vec3 u = ring.edges[0];
  return {limit, u, length(n) > 0 ? cross(normalized(n), u) : Vec3{}};
}

}  // namespace

void correct_dart_limits(CageLevels& cage) {
  const CageLevel& level = cage.levels.back();
  std::vector<std::uint8_t> done(level.points.size(), 0);
  const bool triangles = cage.scheme == SubdivisionScheme::loop;
  for (std::uint32_t f = 0; f < level.face_count(); ++f)
    for (std::uint32_t v : level.vertices(f)) {
      if (done[v] || level.rules[v] != VertexRule::dart || level.semi_sharp[v]) continue;
      done[v] = 1;
      const auto ring = ring_of(level, f, v, triangles);
      if (!ring) continue;
      const DartLimit limit = limit_of(*ring);
      cage.limits[v] = limit.point, cage.tangents_u[v] = limit.tangent_u,
      cage.tangents_v[v] = limit.tangent_v;
    }
}

}  // namespace dupin
