// The footprint's box is cut into cells; those that nothing of the boundary reaches into are inside or
// outside as a whole. The largest rectangles of inside cells are taken one after the other, and what is left
// is put together from rows of cells.
#include "planar_cover.h"

#include <algorithm>
#include <array>

namespace dupin {
namespace {

constexpr double kMargin = kCoverMargin;
constexpr std::size_t kMostInside = 4;
constexpr int kFewestInside = 24;  // an inside rectangle takes no less than this part of the box
constexpr int kArcsOfEllipse = 8;
constexpr int kArcHalvings = 2;  // before an arc's triangle is taken for the arc

enum Cell : char { kOutside, kBoundary, kInside };
/// Row by row.
struct Cells {
  explicit Cells(int n) : n(n), values(static_cast<std::size_t>(n * n), kOutside) {}
  int n;
  std::vector<Cell> values;
  Cell& operator()(int i, int j) { return values[static_cast<std::size_t>(j * n + i)]; }
  Cell operator()(int i, int j) const { return values[static_cast<std::size_t>(j * n + i)]; }
};

struct Range {
  int i0 = 0, j0 = 0, i1 = 0, j1 = 0;
  int area() const { return (i1 - i0) * (j1 - j0); }
};

class Grid {
 public:
  Grid(const Box2& box, int n) : n(n), box_(box), step_(box.size() / n) {}
  const int n;
  Box2 box(const Range& r, double margin) const {
    Box2 b;
    b.add(box_.lo + Vec2{(r.i0 - margin) * step_.x, (r.j0 - margin) * step_.y});
    b.add(box_.lo + Vec2{(r.i1 + margin) * step_.x, (r.j1 + margin) * step_.y});
    return b;
  }
  Box2 cell(int i, int j) const { return box({i, j, i + 1, j + 1}, kMargin); }
  /// A point of the cell that designs are not symmetric about: on an arc's chord the region's test may go
  /// either way.
  Vec2 sample(int i, int j) const { return box_.lo + Vec2{(i + 0.4637) * step_.x, (j + 0.5281) * step_.y}; }
  /// The cells that overlap a box, margins included.
  Range overlapping(const Box2& reach) const {
    const auto cell_of = [this](double v) {
      return static_cast<int>(std::clamp(std::floor(v), 0.0, n - 1.0));
    };
    const Vec2 lo = reach.lo - box_.lo, hi = reach.hi - box_.lo;
    return {cell_of(lo.x / step_.x - kMargin), cell_of(lo.y / step_.y - kMargin),
            cell_of(hi.x / step_.x + kMargin) + 1, cell_of(hi.y / step_.y + kMargin) + 1};
  }

 private:
  Box2 box_;
  Vec2 step_;
};

/// A segment or a triangle against a box: apart if their boxes are, or if one of the sides' lines has the box
/// on one side and no corner of the hull on that side.
template <std::size_t N>
bool reaches(const std::array<Vec2, N>& hull, const Box2& box) {
  Box2 around;
  for (const Vec2 p : hull) around.add(p);
  if (!overlap(around, box)) return false;
  for (std::size_t k = 0; k < N; ++k) {
    const Vec2 a = hull[k], d = hull[(k + 1) % N] - a;
    const double center = cross(d, box.center() - a);
    const double reach = (std::abs(d.x) * box.size().y + std::abs(d.y) * box.size().x) / 2;
    if (std::abs(center) <= reach) continue;
    if (std::all_of(hull.begin(), hull.end(), [&](Vec2 q) { return cross(d, q - a) * center <= 0; }))
      return false;
  }
  return true;
}

/// Calls f on the triangles of the arc's parts. Halving a rational quadratic with weights 1, w, 1 gives two
/// with 1, w', 1.
template <class F>
void for_triangles(Vec2 p0, Vec2 p1, Vec2 p2, double w, int halvings, F&& f) {
  if (halvings == 0) return f(std::array<Vec2, 3>{p0, p1, p2});
  const Vec2 a = (p0 + p1 * w) / (1 + w), c = (p2 + p1 * w) / (1 + w), m = (a + c) * 0.5;
  const double half = std::sqrt((1 + w) / 2);
  for_triangles(p0, a, m, half, halvings - 1, f);
  for_triangles(m, c, p2, half, halvings - 1, f);
}

bool reaches(const ArcPiece& arc, const Box2& box) {
  bool any = false;
  for_triangles(arc.p0, arc.p1, arc.p2, arc.w, kArcHalvings,
                [&](const std::array<Vec2, 3>& t) { any = any || reaches(t, box); });
  // The chord counts, too: which side of it a point lies on decides whether it is in the bulge.
  return any || reaches(std::array<Vec2, 2>{arc.p0, arc.p2}, box);
}

/// The ellipse |m (p − c)| = 1 as arcs; its own points are c + m⁻¹(cos θ, sin θ).
void add_arcs(const EllipsePiece& e, std::vector<ArcPiece>& arcs) {
  const double det = e.mxx * e.myy - e.mxy * e.mxy, step = 2 * 3.14159265358979323846 / kArcsOfEllipse,
               w = std::cos(step / 2);
  const auto point = [&](double angle, double radius) {
    const Vec2 q{std::cos(angle) * radius, std::sin(angle) * radius};
    return e.center + Vec2{e.myy * q.x - e.mxy * q.y, e.mxx * q.y - e.mxy * q.x} / det;
  };
  std::array<Vec2, kArcsOfEllipse + 1> ends;
  for (int k = 0; k < kArcsOfEllipse; ++k) ends[static_cast<std::size_t>(k)] = point(k * step, 1);
  ends.back() = ends.front();
  for (int k = 0; k < kArcsOfEllipse; ++k)
    arcs.push_back({ends[static_cast<std::size_t>(k)], point((k + 0.5) * step, 1 / w),
                    ends[static_cast<std::size_t>(k) + 1], w, e.feature});
}

/// The boundary as lines and arcs alone.
struct Boundary {
  std::vector<LinePiece> lines;
  std::vector<ArcPiece> arcs;
};
Boundary boundary_of(const PartDps& part, const QuadricDp& dp) {
  Boundary b;
  b.lines.assign(part.lines.begin() + dp.first_line, part.lines.begin() + dp.first_line + dp.lines);
  b.arcs.assign(part.arcs.begin() + dp.first_arc, part.arcs.begin() + dp.first_arc + dp.arcs);
  for (std::uint32_t i = dp.first_ellipse; i < dp.first_ellipse + dp.ellipses; ++i)
    add_arcs(part.ellipses[i], b.arcs);
  return b;
}

/// Cells that the hull reaches into become boundary cells.
template <std::size_t N>
void touch(const Grid& grid, Cells& cells, const std::array<Vec2, N>& hull) {
  Box2 around;
  for (const Vec2 p : hull) around.add(p);
  const Range r = grid.overlapping(around);
  for (int j = r.j0; j < r.j1; ++j)
    for (int i = r.i0; i < r.i1; ++i)
      if (reaches(hull, grid.cell(i, j))) cells(i, j) = kBoundary;
}

/// Which cells lie beyond one of the footprint's sides as a whole; what a side reaches into becomes a
/// boundary cell.
Cells beyond_footprint(const QuadricDp& dp, const Grid& grid, Cells& cells) {
  Cells beyond(grid.n);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = dp.footprint[k], d = dp.footprint[(k + 1) % 4] - a;
    if (d.x == 0 && d.y == 0) continue;
    for (int j = 0; j < grid.n; ++j)
      for (int i = 0; i < grid.n; ++i) {
        const Box2 cell = grid.cell(i, j);
        const double g = cross(d, cell.center() - a),
                     reach = (std::abs(d.x) * cell.size().y + std::abs(d.y) * cell.size().x) / 2;
        if (g < -reach) beyond(i, j) = kBoundary;
        if (g < reach) cells(i, j) = kBoundary;
      }
  }
  return beyond;
}

Cells classify(const PartDps& part, const QuadricDp& dp, const Boundary& boundary, const Grid& grid) {
  Cells cells(grid.n);
  const Cells beyond = beyond_footprint(dp, grid, cells);
  for (const LinePiece& l : boundary.lines) touch(grid, cells, std::array<Vec2, 2>{l.p0, l.p1});
  for (const ArcPiece& a : boundary.arcs)
    for_triangles(a.p0, a.p1, a.p2, a.w, kArcHalvings,
                  [&](const std::array<Vec2, 3>& t) { touch(grid, cells, t); });
  for (int j = 0; j < grid.n; ++j)
    for (int i = 0; i < grid.n; ++i) {
      Cell& cell = cells(i, j);
      if (beyond(i, j) == kBoundary) {
        cell = kOutside;
      } else if (cell == kOutside && pieces_contain(part, dp, grid.sample(i, j))) {
        cell = kInside;
      }
    }
  return cells;
}

/// Row by row, with how many inside cells stand on each column; every rectangle is tried by its top row's
/// ends.
Range largest(const Cells& cells) {
  Range best;
  std::vector<int> height(static_cast<std::size_t>(cells.n), 0);
  for (int j = 0; j < cells.n; ++j) {
    for (int i = 0; i < cells.n; ++i) {
      int& h = height[static_cast<std::size_t>(i)];
      h = cells(i, j) == kInside ? h + 1 : 0;
    }
    for (int i = 0; i < cells.n; ++i) {
      int lowest = cells.n;
      for (int k = i; k < cells.n && height[static_cast<std::size_t>(k)] > 0; ++k) {
        lowest = std::min(lowest, height[static_cast<std::size_t>(k)]);
        const Range range{i, j + 1 - lowest, k + 1, j + 1};
        if (range.area() > best.area()) best = range;
      }
    }
  }
  return best;
}

/// Runs of cells in a row, put together with the rows before that have the same.
std::vector<Range> rows_of(const Cells& cells) {
  std::vector<Range> result, open;
  for (int j = 0; j <= cells.n; ++j) {
    std::vector<Range> runs;
    for (int i = 0; i < cells.n && j < cells.n; ++i) {
      if (cells(i, j) == kOutside) continue;
      if (!runs.empty() && runs.back().i1 == i) {
        ++runs.back().i1;
      } else {
        runs.push_back({i, j, i + 1, j + 1});
      }
    }
    for (const Range& before : open) {
      const auto same = std::find_if(runs.begin(), runs.end(),
                                     [&](const Range& r) { return r.i0 == before.i0 && r.i1 == before.i1; });
      if (same != runs.end()) {
        same->j0 = before.j0;
      } else {
        result.push_back(before);
      }
    }
    open = std::move(runs);
  }
  return result;
}

double distance_to(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double t = dot(d, d) > 0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0;
  return length(p - (a + d * t));
}

bool in_bulge(const ArcPiece& arc, Vec2 p) {
  const double area = cross(arc.p1 - arc.p0, arc.p2 - arc.p0);
  if (area == 0) return false;
  const double b0 = cross(arc.p1 - p, arc.p2 - p) / area, b2 = cross(arc.p0 - p, arc.p1 - p) / area,
               b1 = 1 - b0 - b2;
  return b0 >= 0 && b2 >= 0 && b1 > 0 && b1 * b1 < 4 * arc.w * arc.w * b0 * b2;
}

/// Of a few points of the box the one that is farthest from every segment, chord and side of an arc's
/// triangle.
Vec2 choose_reference(const BoundaryRectangle& r) {
  constexpr int kTries = 7;
  Vec2 best = r.box.center();
  double best_distance = -1;
  for (int j = 1; j < kTries; ++j)
    for (int i = 1; i < kTries; ++i) {
      const Vec2 p = r.box.lo + Vec2{r.box.size().x * i / kTries, r.box.size().y * j / kTries};
      double nearest = INFINITY;
      for (const LinePiece& l : r.lines) nearest = std::min(nearest, distance_to(p, l.p0, l.p1));
      for (const ArcPiece& a : r.arcs) {
        nearest = std::min(nearest, distance_to(p, a.p0, a.p2));
        for_triangles(a.p0, a.p1, a.p2, a.w, kArcHalvings, [&](const std::array<Vec2, 3>& t) {
          nearest = std::min(nearest, distance_to(p, t[0], t[2]));
        });
      }
      if (nearest > best_distance) best = p, best_distance = nearest;
    }
  return best;
}

BoundaryRectangle boundary_rectangle(const PartDps& part, const QuadricDp& dp, const Boundary& boundary,
                                     const Grid& grid, const Range& range) {
  BoundaryRectangle r;
  r.box = grid.box(range, 0);
  // What is drawn of the rectangle is a little more, for edges and rounding.
  const Box2 wide = grid.box(range, 0.5);
  for (const LinePiece& l : boundary.lines)
    if (reaches(std::array<Vec2, 2>{l.p0, l.p1}, wide)) r.lines.push_back(l);
  for (const ArcPiece& a : boundary.arcs)
    if (reaches(a, wide)) r.arcs.push_back(a);
  r.reference = choose_reference(r);
  r.reference_inside = pieces_contain(part, dp, r.reference);
  for (const ArcPiece& a : r.arcs) r.reference_inside ^= in_bulge(a, r.reference);
  return r;
}

bool crosses(Vec2 r, Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = p - r;
  if ((cross(d, a - r) > 0) == (cross(d, b - r) > 0)) return false;
  return (cross(b - a, p - a) > 0) != (cross(b - a, r - a) > 0);
}

}  // namespace

PlanarCover planar_cover(const PartDps& part, const QuadricDp& dp, int resolution) {
  Box2 box;
  for (const Vec2 c : dp.footprint) box.add(c);
  const Boundary boundary = boundary_of(part, dp);
  const Grid grid(box, resolution);
  PlanarCover cover;
  if (!(box.size().x > 0 && box.size().y > 0)) return cover;
  Cells cells = classify(part, dp, boundary, grid);
  while (cover.inside.size() < kMostInside) {
    const Range r = largest(cells);
    if (r.area() * kFewestInside < resolution * resolution) break;
    cover.inside.push_back(grid.box(r, 0));
    for (int j = r.j0; j < r.j1; ++j)
      for (int i = r.i0; i < r.i1; ++i) cells(i, j) = kOutside;
  }
  for (const Range& r : rows_of(cells))
    cover.boundary.push_back(boundary_rectangle(part, dp, boundary, grid, r));
  return cover;
}

bool boundary_contains(const BoundaryRectangle& r, Vec2 p) {
  bool inside = r.reference_inside;
  for (const LinePiece& l : r.lines) inside ^= crosses(r.reference, p, l.p0, l.p1);
  for (const ArcPiece& a : r.arcs) inside ^= crosses(r.reference, p, a.p0, a.p2) != in_bulge(a, p);
  return inside;
}

}  // namespace dupin
