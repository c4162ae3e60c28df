// Which faces of a cage are regular, and their control points.
#include <algorithm>
#include <optional>

#include "limit_basis.h"

namespace dupin {
namespace {

/// A face seen from one of its corners: walks around the corner's vertex as far as the surface goes on.
class Walker {
 public:
  explicit Walker(const CageLevel& level) : level_(level) {}

  std::uint32_t across(std::uint32_t face, std::uint32_t edge) const {
    const auto& faces = level_.edge_faces[edge];
    return faces[0] == kNoIndex ? kNoIndex : faces[0] == face ? faces[1] : faces[0];
  }
  int corner_of(std::uint32_t face, std::uint32_t vertex) const {
    const auto vertices = level_.vertices(face);
    return static_cast<int>(std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin());
  }
  std::uint32_t vertex(std::uint32_t face, int corner) const {
    const auto vertices = level_.vertices(face);
    const auto n = static_cast<int>(vertices.size());
    return vertices[static_cast<std::size_t>((corner % n + n) % n)];
  }
  std::uint32_t edge(std::uint32_t face, int corner) const {
    const auto edges = level_.edges(face);
    const auto n = static_cast<int>(edges.size());
    return edges[static_cast<std::size_t>((corner % n + n) % n)];
  }
  /// The next face around the vertex, against the clock: across the edge that ends in it.
  std::uint32_t next(std::uint32_t face, std::uint32_t vertex) const {
    return across(face, edge(face, corner_of(face, vertex) - 1));
  }
  std::uint32_t before(std::uint32_t face, std::uint32_t vertex) const {
    return across(face, edge(face, corner_of(face, vertex)));
  }

 private:
  const CageLevel& level_;
};

/// The faces around a vertex that the surface goes on over, against the clock; whether they close.
struct Sector {
  std::vector<std::uint32_t> faces;
  bool closed = false;
};

/// Of at most `most` faces: more are never regular.
Sector sector_of(const Walker& walker, std::uint32_t face, std::uint32_t vertex, std::size_t most) {
  Sector sector;
  std::uint32_t first = face;
  for (std::size_t i = 0; i < most; ++i) {
    const std::uint32_t before = walker.before(first, vertex);
    if (before == face) sector.closed = true;
    if (before == face || before == kNoIndex) break;
    first = before;
  }
  if (sector.closed) first = face;
  for (std::uint32_t f = first; f != kNoIndex && sector.faces.size() < most; f = walker.next(f, vertex)) {
    if (!sector.faces.empty() && f == first) break;
    sector.faces.push_back(f);
  }
  return sector;
}

/// Gathers the control points of a regular face.
class RegularFace {
 public:
  RegularFace(const CageLevel& level, int corners) : level_(level), walker_(level), corners_(corners) {}

  std::optional<LimitPatch> patch(std::uint32_t face, int rotation) const {
    if (static_cast<int>(level_.vertices(face).size()) != corners_) return std::nullopt;
    for (int i = 0; i < corners_; ++i)
      if (!regular_at(face, i)) return std::nullopt;
    return corners_ == 4 ? bicubic(face, rotation) : quartic(face, rotation);
  }

 private:
  bool regular_at(std::uint32_t face, int corner) const {
    const std::uint32_t vertex = walker_.vertex(face, corner);
    if (level_.semi_sharp[vertex]) return false;
    const std::size_t whole = corners_ == 4 ? 4 : 6;
    const Sector sector = sector_of(walker_, face, vertex, whole + 1);
    const std::size_t count = sector.faces.size();
    for (std::uint32_t f : sector.faces)
      if (static_cast<int>(level_.vertices(f).size()) != corners_) return false;
    switch (level_.rules[vertex]) {
      case VertexRule::smooth:
        return sector.closed && count == whole;
      case VertexRule::crease:
        return !sector.closed && count == whole / 2;
      case VertexRule::corner:
        return !sector.closed && count == 1;
      default:
        return false;
    }
  }

  const Vec3& at(std::uint32_t vertex) const { return level_.points[vertex]; }

  /// Where there is no face, the spline's control points are mirrored: that makes its border the crease's
  /// curve.
  LimitPatch bicubic(std::uint32_t face, int rotation) const {
    // Places in the 4 × 4 control points: the corners, the two beyond each side, the one beyond each corner.
    constexpr std::size_t kCorner[4] = {5, 6, 10, 9}, kBeyond[4][2] = {{1, 2}, {7, 11}, {14, 13}, {8, 4}},
                          kDiagonal[4] = {0, 3, 15, 12};
    constexpr int kInwards[4] = {4, -1, -4, 1};  // from beyond a side towards the other side
    std::array<Vec3, 16> q;
    std::array<bool, 16> known{};
    const auto set = [&](std::size_t place, const Vec3& p) { q[place] = p, known[place] = true; };
    for (int i = 0; i < 4; ++i) {
      const int corner = i + rotation;
      const std::uint32_t v = walker_.vertex(face, corner), w = walker_.vertex(face, corner + 1);
      set(kCorner[i], at(v));
      const std::uint32_t beyond = walker_.across(face, walker_.edge(face, corner));
      if (beyond == kNoIndex) continue;
      set(kBeyond[i][0], at(walker_.vertex(beyond, walker_.corner_of(beyond, v) + 1)));
      set(kBeyond[i][1], at(walker_.vertex(beyond, walker_.corner_of(beyond, w) - 1)));
      const std::uint32_t diagonal = walker_.before(beyond, v);
      if (diagonal != kNoIndex && walker_.across(face, walker_.edge(face, corner - 1)) != kNoIndex)
        set(kDiagonal[i], at(walker_.vertex(diagonal, walker_.corner_of(diagonal, v) + 2)));
    }
    const auto mirror = [&](std::size_t place, int step) {
      const auto p = static_cast<int>(place);
      set(place, q[static_cast<std::size_t>(p + step)] * 2 - q[static_cast<std::size_t>(p + 2 * step)]);
    };
    for (int i = 0; i < 4; ++i)
      for (std::size_t place : kBeyond[i])
        if (!known[place]) mirror(place, kInwards[i]);
    for (int i = 0; i < 4; ++i) {
      if (known[kDiagonal[i]]) continue;
      // Beyond the side that ends here or the one that starts here, whichever has no face.
      const bool starts = walker_.across(face, walker_.edge(face, i + rotation)) == kNoIndex;
      mirror(kDiagonal[i], kInwards[starts ? i : (i + 3) % 4]);
    }
    return from_bicubic_spline(q);
  }

  /// The vertex that follows the face's own around a corner, k faces on against the clock (k < 0: with it),
  /// or nothing beyond a crease.
  std::optional<Vec3> around(std::uint32_t face, std::uint32_t vertex, int k) const {
    for (; face != kNoIndex && k > 0; --k) face = walker_.next(face, vertex);
    for (; face != kNoIndex && k < 0; ++k) face = walker_.before(face, vertex);
    if (face == kNoIndex) return std::nullopt;
    return at(walker_.vertex(face, walker_.corner_of(face, vertex) + 1));
  }

  LimitPatch quartic(std::uint32_t face, int rotation) const {
    // The support around each corner, in the order of faces from the triangle itself: first the edge that
    // starts there.
    constexpr int kPlaces[3][6] = {{1, 2, 3, 4, 5, 6}, {2, 0, 6, 7, 8, 9}, {0, 1, 9, 10, 11, 3}};
    std::array<std::optional<Vec3>, 12> q;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = walker_.vertex(face, i + rotation);
      q[static_cast<std::size_t>(i)] = at(v);
      for (int k = -5; k <= 5; ++k)
        if (const auto p = around(face, v, k)) q[static_cast<std::size_t>(kPlaces[i][(k + 6) % 6])] = *p;
      // The last face of an open sector ends in an edge that no face starts with.
      add_last(face, v, kPlaces[i], q);
    }
    mirror_beyond(q);
    std::array<Vec3, 12> control;
    for (std::size_t k = 0; k < 12; ++k) control[k] = q[k].value_or(Vec3{});
    return from_box_spline(control);
  }

  void add_last(std::uint32_t face, std::uint32_t v, const int* places,
                std::array<std::optional<Vec3>, 12>& q) const {
    for (int k = 0; k < 6; ++k) {
      const std::uint32_t next = walker_.next(face, v);
      if (next != kNoIndex) {
        face = next;
        continue;
      }
      q[static_cast<std::size_t>(places[(k + 1) % 6])] =
          at(walker_.vertex(face, walker_.corner_of(face, v) - 1));
      return;
    }
  }

  /// Beyond a border edge ab of a triangle abc lies a + b − c; what no such triangle gives lies beyond a
  /// corner.
  static void mirror_beyond(std::array<std::optional<Vec3>, 12>& q) {
    constexpr std::array<std::array<int, 2>, 6> kRing{{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}};
    const auto index = [](int x, int y) {
      for (std::size_t k = 0; k < 12; ++k)
        if (kLoopSupport[k][0] == x && kLoopSupport[k][1] == y) return static_cast<int>(k);
      return -1;
    };
    std::array<std::optional<Vec3>, 12> given = q;
    const auto get = [&](int x, int y) -> std::optional<Vec3> {
      const int k = index(x, y);
      return k < 0 ? std::nullopt : given[static_cast<std::size_t>(k)];
    };
    for (int pass = 0; pass < 3; ++pass) {
      for (std::size_t k = 0; k < 12; ++k) {
        const int x = kLoopSupport[k][0], y = kLoopSupport[k][1];
        for (std::size_t r = 0; r < 6 && !q[k]; ++r) {
          // The rhombus x, a, b with the far corner a + b − x.
          const auto &s = kRing[r], &t = kRing[(r + 1) % 6];
          const auto a = get(x + s[0], y + s[1]), b = get(x + t[0], y + t[1]),
                     c = get(x + s[0] + t[0], y + s[1] + t[1]);
          if (a && b && c) q[k] = *a + *b - *c;
        }
        // Beyond a corner: straight on.
        for (std::size_t r = 0; r < 6 && !q[k] && pass > 0; ++r) {
          const auto a = get(x + kRing[r][0], y + kRing[r][1]),
                     b = get(x + 2 * kRing[r][0], y + 2 * kRing[r][1]);
          if (a && b) q[k] = *a * 2 - *b;
        }
      }
      given = q;
    }
  }

  const CageLevel& level_;
  Walker walker_;
  int corners_;
};

}  // namespace

std::optional<LimitPatch> regular_patch(const CageLevel& level, int corners, std::uint32_t face,
                                        int rotation) {
  return RegularFace(level, corners).patch(face, rotation);
}

}  // namespace dupin
