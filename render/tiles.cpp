#include "tiles.h"

#include <bit>
#include <limits>

#include "tile_heights.h"
#include "tile_proxy.h"

namespace dupin {
namespace {

/// A cell, as a tile, costs about as much as the tests of so many pixels: a DP that is smaller than this many
/// a cell is drawn whole.
constexpr double kPixelsPerCell = 60;
/// Tiles are cut in two until they are no thicker than this many pixels, or no larger, or cut so often.
constexpr double kMostBendPx = 8, kSmallestCut = 150;
constexpr int kMostCuts = 12, kMostCutsNear = 5;

std::uint32_t word(double v) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(v));
}
Texel texel(double x, double y, double z, double w) {
  return {word(x), word(y), word(z), word(w)};
}

/// The pixel at this place from the picture's middle, or the nearest in the picture.
double whole_pixel(double at, int size) {
  return std::clamp(std::floor(at + size / 2.0), 0.0, std::min(size, 65536) - 1.0);
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

/// Normals of a tile, in the DP's frame, as seen from an eye or a direction there.
struct LocalView {
  bool perspective;
  Vec3 eye;
};

enum class Facing { away, towards, unknown };

/// Of the surface in the hull of the points.
Facing facing(const QuadricDp& dp, const std::array<Vec3, 8>& points, const LocalView& view) {
  std::array<Vec3, 8> normals;
  Vec3 sum, middle;
  for (std::size_t i = 0; i < 8; ++i) {
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
      : seen_(seen), dp_(seen.dp->dp), options_(options), tiles_(tiles) {
    if (!dp_.planar)
      picture_ = PictureOfDp(*seen.camera, seen.dp->origin, dp_.u, dp_.v, dp_.n(),
                             {options.width / 2.0, options.height / 2.0});
  }

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
    const std::uint32_t kind = kind_ | (cell.conic ? kConicTile : 0);
    if (dp_.planar) return emit(cell, cell.corners, {0, 0}, kind, false, nullptr);
    add_curved(cell, cell.corners, {dp_.z_lo, dp_.z_hi}, kind | kCurvedTile, 0);
  }

  /// `ends` is the tile's own part of the DP's z: more than where the surface is, as a point within rounding
  /// of the tile's sides may lie above or below that.
  void add_curved(const RegionCell& cell, const Corners& corners, const Interval& ends, std::uint32_t kind,
                  int cuts) {
    const Box2 box = box_of(corners);
    const Heights h = heights(dp_, box, ends);
    const double between =
        h.count == 2 ? (std::min(h.z[0].hi, h.z[1].hi) + std::max(h.z[0].lo, h.z[1].lo)) / 2 : 0;
    for (int k = 0; k < h.count; ++k) {
      Interval band = ends;
      if (h.count == 2) (h.z[k].hi < between ? band.hi : band.lo) = between;
      const Hull hull = hull_of(dp_, corners, box, h.z[k]);
      Facing side = seen_.towards ? Facing::towards : seen_.away ? Facing::away : Facing::unknown;
      if (side == Facing::unknown) side = facing(dp_, hull.points, local_view());
      const bool solid = seen_.camera->cull_turned_away;
      if (solid && side == Facing::away) continue;
      TileProxy proxy;
      const auto seen = picture_.around(hull.points, proxy);
      if (seen == PictureOfDp::Seen::nothing) continue;
      const bool near = seen == PictureOfDp::Seen::near_eye;
      if (!(kind & kPiecesTile) && cuts < (near ? kMostCutsNear : kMostCuts) &&
          (near || worth_a_cut(hull, proxy))) {
        cut(cell, corners, band, (h.z[k].lo + h.z[k].hi) / 2, hull, kind, cuts + 1);
        continue;
      }
      std::uint32_t tile = kind;
      if (solid || side != Facing::unknown) tile |= kOneRootTile;
      if (near) tile |= kPrismTile;
      emit(cell, corners, band, tile, side == Facing::away, near ? nullptr : &proxy);
    }
  }

  bool worth_a_cut(const Hull& hull, const TileProxy& proxy) const {
    return proxy.area > kSmallestCut && hull.thickness * picture_.px_per_unit(hull.points) > kMostBendPx;
  }

  /// In two, across the way that bends most.
  void cut(const RegionCell& cell, const Corners& c, const Interval& z, double middle, const Hull& hull,
           std::uint32_t kind, int cuts) {
    const auto bend = [&](Vec2 way) {
      return std::abs(dp_.lambda_u * way.x * way.x + dp_.lambda_v * way.y * way.y);
    };
    const Vec2 across = (c[1] - c[0] + c[2] - c[3]) * 0.5, down = (c[3] - c[0] + c[2] - c[1]) * 0.5;
    const bool is_across =
        bend(across) != bend(down) ? bend(across) > bend(down) : length(across) > length(down);
    if (!hull.slanting && hull.points[4].z - hull.points[0].z > length(is_across ? across : down)) {
      add_curved(cell, c, {z.lo, middle}, kind, cuts);
      add_curved(cell, c, {middle, z.hi}, kind, cuts);
    } else if (is_across) {
      add_curved(cell, part_of(c, 0, 0.5, 0, 1), z, kind, cuts);
      add_curved(cell, part_of(c, 0.5, 1, 0, 1), z, kind, cuts);
    } else {
      add_curved(cell, part_of(c, 0, 1, 0, 0.5), z, kind, cuts);
      add_curved(cell, part_of(c, 0, 1, 0.5, 1), z, kind, cuts);
    }
  }

  LocalView local_view() const {
    const PartCamera& camera = *seen_.camera;
    const Vec3 way = camera.perspective ? camera.eye - seen_.dp->origin : camera.eye, n = dp_.n();
    return {camera.perspective, {dot(way, dp_.u), dot(way, dp_.v), dot(way, n)}};
  }

  void emit(const RegionCell& cell, const Corners& c, const Interval& z, std::uint32_t kind, bool from_behind,
            const TileProxy* proxy) {
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
    if (proxy) {
      const double x = 2.0 / options_.width, y = 2.0 / options_.height;
      const Corners& p = proxy->corners;
      t.push_back(texel(p[0].x * x, p[0].y * y, p[1].x * x, p[1].y * y));
      t.push_back(texel(p[2].x * x, p[2].y * y, p[3].x * x, p[3].y * y));
      const Vec2 middle = (p[0] + p[1] + p[2] + p[3]) * 0.25;
      const double column = whole_pixel(middle.x, options_.width),
                   row = whole_pixel(middle.y, options_.height);
      const Vec3 start =
          picture_.at({column + 0.5 - options_.width / 2.0, row + 0.5 - options_.height / 2.0});
      t.push_back(texel(start.x, start.y, start.z, 0));
      t.back()[3] = static_cast<std::uint32_t>(column) | static_cast<std::uint32_t>(row) << 16;
    }
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
  PictureOfDp picture_;
  std::uint32_t kind_ = 0;
  std::array<std::uint32_t, 4> run_{};
};

}  // namespace

std::uint32_t tile_texels(std::uint32_t kind) {
  const bool proxy = (kind & kCurvedTile) && !(kind & kPrismTile);
  return 3U + (proxy ? 3U : 0U) + (kind & kConicTile ? 3U : 0U) + (kind & kEdgesTile ? 1U : 0U);
}

void Tiles::clear() {
  for (auto& [kind, texels] : by_kind) texels.clear();
  edges.clear();
}

void add_tiles(const SeenDp& seen, const TileOptions& options, Tiles& tiles) {
  DpTiles(seen, options, tiles).add();
}

}  // namespace dupin
