#include "tiles.h"

#include <bit>
#include <limits>

namespace dupin {
namespace {

/// A cell, as a tile, costs about as much as the tests of so many pixels: a DP that is smaller than this many
/// a cell is drawn whole.
constexpr double kPixelsPerCell = 60;
/// Tiles are cut until the surface bends by no more than this many pixels within one, or they are this small.
constexpr double kMostBendPx = 3, kSmallestPx = 12;
constexpr int kMostCuts = 24;

std::uint32_t word(double v) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(v));
}
Texel texel(double x, double y, double z, double w) {
  return {word(x), word(y), word(z), word(w)};
}

struct Interval {
  double lo, hi;
  bool empty() const { return !(lo <= hi); }
};
Interval operator+(const Interval& a, const Interval& b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
Interval times(const Interval& a, double k) {
  return k < 0 ? Interval{a.hi * k, a.lo * k} : Interval{a.lo * k, a.hi * k};
}
Interval times(const Interval& a, const Interval& b) {
  const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
  return {lo, hi};
}
/// Of x², x in the interval.
Interval square(const Interval& a) {
  const double l = a.lo * a.lo, h = a.hi * a.hi;
  return {a.lo <= 0 && a.hi >= 0 ? 0 : std::min(l, h), std::max(l, h)};
}
Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// Where F = 0 lies above a rectangle of (x, y), within the DP's ends: up to two intervals of z. From
///     ½ c z² − p z + q = 0,  p = 1 − a x − b y,  q = ½ (λu x² + λv y²).
struct Heights {
  Interval z[2];
  int count = 0;
};
Heights heights(const QuadricDp& dp, const Box2& box) {
  const Interval whole{dp.z_lo, dp.z_hi};
  const Interval x{box.lo.x, box.hi.x}, y{box.lo.y, box.hi.y};
  const Interval p = Interval{1, 1} + times(x, -dp.a) + times(y, -dp.b);
  const Interval q = times(square(x), dp.lambda_u / 2) + times(square(y), dp.lambda_v / 2);
  if (!(p.lo > 0)) return {{whole, {}}, 1};
  const Interval d = square(p) + times(q, -2 * dp.c);
  if (d.hi < 0) return {};
  const Interval root{std::sqrt(std::max(0.0, d.lo)), std::sqrt(d.hi)}, sum = p + root;
  const double slack = 2e-6 * (box.size().x + box.size().y + dp.z_hi - dp.z_lo);
  Heights h;
  const auto add = [&](Interval z) {
    z = common({z.lo - slack, z.hi + slack}, whole);
    if (z.empty()) return;
    if (h.count == 1 && z.lo <= h.z[0].hi && h.z[0].lo <= z.hi) {
      h.z[0] = {std::min(z.lo, h.z[0].lo), std::max(z.hi, h.z[0].hi)};
    } else {
      h.z[h.count++] = z;
    }
  };
  add(times(times(q, 2), {1 / sum.hi, 1 / sum.lo}));
  if (dp.c != 0) add(times(sum, 1 / dp.c));
  return h;
}

using Corners = std::array<Vec2, 4>;

Box2 box_of(const Corners& corners) {
  Box2 box;
  for (const Vec2 c : corners) box.add(c);
  return box;
}

Corners part_of(const Corners& c, double s0, double s1, double t0, double t1) {
  const auto at = [&](double s, double t) {
    return (c[0] * (1 - s) + c[1] * s) * (1 - t) + (c[3] * (1 - s) + c[2] * s) * t;
  };
  return {at(s0, t0), at(s1, t0), at(s1, t1), at(s0, t1)};
}

/// Into how many parts a way along the surface is cut.
int cuts(const QuadricDp& dp, Vec2 way, double px_per_unit) {
  const double curved = std::abs(dp.lambda_u * way.x * way.x + dp.lambda_v * way.y * way.y),
               px = length(way) * px_per_unit;
  // The bend of a part is an eighth of curved / n², in the DP's unit.
  const double n = std::min(std::sqrt(curved * px_per_unit / (8 * kMostBendPx)), px / kSmallestPx);
  return static_cast<int>(std::clamp(std::ceil(n), 1.0, static_cast<double>(kMostCuts)));
}

/// Normals of a tile, in the DP's frame, as seen from an eye or a direction there.
struct LocalView {
  bool perspective;
  Vec3 eye;
};

enum class Facing { away, towards, unknown };

Facing facing(const QuadricDp& dp, const Corners& corners, const Interval& z, const LocalView& view) {
  std::array<Vec3, 8> points;
  std::array<Vec3, 8> normals;
  Vec3 sum, middle;
  for (std::size_t i = 0; i < 8; ++i) {
    points[i] = {corners[i % 4].x, corners[i % 4].y, i < 4 ? z.lo : z.hi};
    normals[i] = normalized(quadric_gradient(dp, points[i]));
    sum += normals[i];
    middle += points[i] * 0.125;
  }
  const Vec3 axis = normalized(sum);
  // Every point of the prism and every normal in it: the eye is on one side of all tangent planes if it is
  // for the corners' normals, widened by where in the prism they are.
  double radius = 0, cosine = 1;
  for (std::size_t i = 0; i < 8; ++i) {
    radius = std::max(radius, length(points[i] - middle));
    cosine = std::min(cosine, dot(normals[i], axis));
  }
  const Vec3 towards = view.perspective ? view.eye - middle : view.eye;
  const double l = length(towards), sin_sphere = view.perspective ? radius / l : 0;
  if (!(cosine > 0 && sin_sphere < 1)) return Facing::unknown;
  const double sin_cone = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + 1e-6,
               cos_sphere = std::sqrt(1 - sin_sphere * sin_sphere);
  const double cos_sum = cosine * cos_sphere - sin_cone * sin_sphere,
               sin_sum = sin_cone * cos_sphere + cosine * sin_sphere;
  const double along = dot(axis, towards);
  if (cos_sum <= 0 || std::abs(along) <= sin_sum * l) return Facing::unknown;
  return (along < 0) != dp.flipped ? Facing::away : Facing::towards;
}

class DpTiles {
 public:
  DpTiles(const SeenDp& seen, const TileOptions& options, Tiles& tiles)
      : seen_(seen), dp_(seen.dp->dp), options_(options), tiles_(tiles) {}

  void add() {
    if (whole()) {
      RegionCell cell{dp_.footprint, std::nullopt};
      kind_ = kPiecesTile | (options_.flats ? seen_.dp->flat << kFlatShift : 0) |
              (dp_.planes > 0 ? kPlanesTile : 0);
      add_cell(cell);
      return;
    }
    kind_ = dp_.planes > 0 ? kPlanesTile : 0;
    if (seen_.dp->cells.empty()) {
      add_cell({dp_.footprint, std::nullopt});
    } else {
      for (const RegionCell& cell : seen_.dp->cells) add_cell(cell);
    }
  }

 private:
  /// Drawn by its pieces: there are no cells, or they are more work.
  bool whole() const {
    const bool pieces = seen_.dp->pieces;
    const std::size_t cells = seen_.dp->cells.size();
    if (!pieces || cells == 1) return false;
    if (cells == 0 || (dp_.planar && dp_.planes > 0)) return true;
    const Vec2 size = box_of(dp_.footprint).size() * seen_.px_per_unit;
    return size.x * size.y < kPixelsPerCell * static_cast<double>(cells);
  }

  void add_cell(const RegionCell& cell) {
    std::uint32_t kind = kind_ | (cell.conic ? kConicTile : 0);
    if (dp_.planar) return emit(cell, cell.corners, {0, 0}, kind, false);
    kind |= kCurvedTile;
    const double px = seen_.px_per_unit;
    const Corners& c = cell.corners;
    int across = 1, down = 1;
    if (std::isfinite(px) && !(kind & kPiecesTile)) {
      across = std::max(cuts(dp_, c[1] - c[0], px), cuts(dp_, c[2] - c[3], px));
      down = std::max(cuts(dp_, c[3] - c[0], px), cuts(dp_, c[2] - c[1], px));
    }
    if (across * down == 1) return add_curved(cell, c, kind, false);
    for (int j = 0; j < down; ++j)
      for (int i = 0; i < across; ++i)
        add_curved(cell,
                   part_of(c, static_cast<double>(i) / across, (i + 1.0) / across,
                           static_cast<double>(j) / down, (j + 1.0) / down),
                   kind, true);
  }

  void add_curved(const RegionCell& cell, const Corners& corners, std::uint32_t kind, bool cut) {
    const bool own = cut || !seen_.dp->cells.empty();
    const Heights h = own ? heights(dp_, box_of(corners)) : Heights{{{dp_.z_lo, dp_.z_hi}, {}}, 1};
    for (int k = 0; k < h.count; ++k) {
      Facing side = seen_.towards ? Facing::towards : seen_.away ? Facing::away : Facing::unknown;
      if (own && side == Facing::unknown) side = facing(dp_, corners, h.z[k], local_view());
      const bool solid = seen_.camera->cull_turned_away;
      if (solid && side == Facing::away) continue;
      std::uint32_t tile = kind;
      if (solid || side != Facing::unknown) tile |= kOneRootTile;
      if (near_eye(corners, h.z[k])) tile |= kPrismTile;
      emit(cell, corners, h.z[k], tile, side == Facing::away);
    }
  }

  LocalView local_view() const {
    const PartCamera& camera = *seen_.camera;
    const Vec3 way = camera.perspective ? camera.eye - seen_.dp->origin : camera.eye, n = dp_.n();
    return {camera.perspective, {dot(way, dp_.u), dot(way, dp_.v), dot(way, n)}};
  }

  /// A proxy in the picture's plane needs all of the prism well before the eye.
  bool near_eye(const Corners& corners, const Interval& z) const {
    const PartCamera& camera = *seen_.camera;
    if (!camera.perspective) return false;
    const Vec3& n = camera.depth.n;
    const double at = dot(n, seen_.dp->origin) + camera.depth.d, u = dot(n, dp_.u), v = dot(n, dp_.v),
                 w = dot(n, dp_.n());
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec2 c : corners)
      for (const double h : {z.lo, z.hi}) {
        const double depth = at + u * c.x + v * c.y + w * h;
        least = std::min(least, depth), most = std::max(most, depth);
      }
    return least < 0.2 * most || least <= 0;
  }

  void emit(const RegionCell& cell, const Corners& c, const Interval& z, std::uint32_t kind,
            bool from_behind) {
    std::array<std::uint32_t, 4> edges{};
    if (options_.edges && (kind & kPiecesTile)) {
      if (seen_.dp->features()) kind |= kEdgesTile;
    } else if (options_.edges) {
      edges = edges_near(c);
      if (edges[1] + edges[2] + edges[3] > 0 || seen_.dp->end_features) kind |= kEdgesTile;
    }
    std::vector<Texel>& t = tiles_.by_kind[kind];
    t.push_back(texel(c[0].x, c[0].y, c[1].x, c[1].y));
    t.push_back(texel(c[2].x, c[2].y, c[3].x, c[3].y));
    t.push_back({word(z.lo), word(z.hi), seen_.slot | (from_behind ? 0x80000000U : 0U), word(seen_.size_px)});
    if (kind & kConicTile) {
      const ConicTest& q = *cell.conic;
      t.push_back(texel(q.a.x, q.a.y, q.a.one, q.b.x));
      t.push_back(texel(q.b.y, q.b.one, q.c.x, q.c.y));
      t.push_back(texel(q.c.one, q.sign, q.steepest, 0));
    }
    if (kind & kEdgesTile) t.push_back(edges);
  }

  /// The features within reach of ink, as a run of their own; the DP's whole run if they are few.
  std::array<std::uint32_t, 4> edges_near(const Corners& c) {
    const FeatureEdges& f = seen_.dp->edges;
    constexpr std::size_t kFew = 4;
    const std::size_t all = f.lines.size() + f.arcs.size() + f.ellipses.size();
    if (all == 0) return {};
    if (all <= kFew) {
      if (run_[1] + run_[2] + run_[3] == 0)
        run_ = write(f, Box2{{-INFINITY, -INFINITY}, {INFINITY, INFINITY}});
      return run_;
    }
    Box2 near = box_of(c);
    const double reach = edge_reach();
    near.lo = near.lo - Vec2{reach, reach}, near.hi = near.hi + Vec2{reach, reach};
    return write(f, near);
  }

  /// In the DP's unit, generously: parts of it may be farther away, or turned so that a pixel is wide on
  /// them.
  double edge_reach() const {
    if (!std::isfinite(seen_.px_per_unit)) return INFINITY;
    const LocalView view = local_view();
    const double slant = dp_.planar ? std::max(std::abs(view.eye.z) / length(view.eye), 0.05) : 0.3;
    return 2 * options_.edge_px / (seen_.px_per_unit * slant);
  }

  std::array<std::uint32_t, 4> write(const FeatureEdges& f, const Box2& near) {
    std::vector<Texel>& t = tiles_.edges;
    std::array<std::uint32_t, 4> run{static_cast<std::uint32_t>(t.size()), 0, 0, 0};
    for (const LinePiece& l : f.lines) {
      if (!overlap(box_of({l.p0, l.p1, l.p1, l.p1}), near)) continue;
      t.push_back(texel(l.p0.x, l.p0.y, l.p1.x, l.p1.y));
      ++run[1];
    }
    for (const ArcPiece& a : f.arcs) {
      if (!overlap(box_of({a.p0, a.p1, a.p2, a.p2}), near)) continue;
      append_arc(a, {}, t);
      ++run[2];
    }
    for (const EllipsePiece& e : f.ellipses) {
      const double det = e.mxx * e.myy - e.mxy * e.mxy;
      const Vec2 half{std::hypot(e.myy, e.mxy) / det, std::hypot(e.mxx, e.mxy) / det};
      if (!overlap(box_of({e.center - half, e.center + half, e.center, e.center}), near)) continue;
      t.push_back(texel(e.center.x, e.center.y, e.mxx, e.mxy));
      t.push_back(texel(e.myy, 0, 0, 0));
      ++run[3];
    }
    return run;
  }

  const SeenDp& seen_;
  const QuadricDp& dp_;
  const TileOptions& options_;
  Tiles& tiles_;
  std::uint32_t kind_ = 0;
  std::array<std::uint32_t, 4> run_{};
};

}  // namespace

std::uint32_t tile_texels(std::uint32_t kind) {
  return 3U + (kind & kConicTile ? 3U : 0U) + (kind & kEdgesTile ? 1U : 0U);
}

void Tiles::clear() {
  for (auto& [kind, texels] : by_kind) texels.clear();
  edges.clear();
}

void add_tiles(const SeenDp& seen, const TileOptions& options, Tiles& tiles) {
  DpTiles(seen, options, tiles).add();
}

}  // namespace dupin
