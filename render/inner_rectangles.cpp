// The footprint's box is cut into cells; those that nothing of the boundary reaches into are inside or outside as a whole, and the
// largest rectangles of inside cells are taken one after the other.
#include "inner_rectangles.h"

#include <array>

namespace dupin {
namespace {

constexpr int kCells = 24;  // along each side of the box
constexpr std::size_t kMostRectangles = 4;
constexpr int kFewestCells = kCells * kCells / 24;

enum Cell : char { kUntouched, kTouched, kInside };
using Cells = std::array<Cell, kCells * kCells>;

class Grid {
 public:
  explicit Grid(const Box2& box) : box_(box), step_(box.size() / kCells) {}
  Box2 cell(int i, int j) const { return box(i, j, i + 1, j + 1); }
  Box2 box(int i0, int j0, int i1, int j1) const {
    Box2 b;
    b.add(box_.lo + Vec2{i0 * step_.x, j0 * step_.y});
    b.add(box_.lo + Vec2{i1 * step_.x, j1 * step_.y});
    return b;
  }
  /// Calls f(i, j) for every cell that overlaps the box.
  template <class F>
  void for_cells(const Box2& reach, F f) const {
    const auto low = [](double v) { return static_cast<int>(std::clamp(std::floor(v), 0.0, double{kCells - 1})); };
    for (int j = low((reach.lo.y - box_.lo.y) / step_.y); j <= low((reach.hi.y - box_.lo.y) / step_.y); ++j)
      for (int i = low((reach.lo.x - box_.lo.x) / step_.x); i <= low((reach.hi.x - box_.lo.x) / step_.x); ++i) f(i, j);
  }

 private:
  Box2 box_;
  Vec2 step_;
};

/// Whether the cell lies on one side of the line through a and b: no segment of it can reach in.
bool beside_line(const Box2& cell, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double center = cross(d, cell.center() - a), reach = (std::abs(d.x) * cell.size().y + std::abs(d.y) * cell.size().x) / 2;
  return std::abs(center) > reach;
}

/// The convex hull of the points reaches into no cell but those marked.
void touch(const Grid& grid, Cells& cells, std::initializer_list<Vec2> hull) {
  Box2 reach;
  for (const Vec2 p : hull) reach.add(p);
  grid.for_cells(reach, [&](int i, int j) {
    const Box2 cell = grid.cell(i, j);
    bool apart = false;
    const std::vector<Vec2> p(hull);
    for (std::size_t k = 0; k < p.size() && !apart; ++k) {
      // Apart if the whole hull lies beyond one of its sides, seen from the cell.
      const Vec2 a = p[k], b = p[(k + 1) % p.size()];
      if (!beside_line(cell, a, b)) continue;
      const double side = cross(b - a, cell.center() - a);
      apart = std::all_of(p.begin(), p.end(), [&](Vec2 q) { return cross(b - a, q - a) * side <= 0; });
    }
    if (!apart) cells[static_cast<std::size_t>(j * kCells + i)] = kTouched;
  });
}

/// Halves a rational quadratic with weights 1, w, 1; both halves again have weights 1, w', 1.
void touch_arc(const Grid& grid, Cells& cells, Vec2 p0, Vec2 p1, Vec2 p2, double w, int depth) {
  if (depth == 0) return touch(grid, cells, {p0, p1, p2});
  const Vec2 a = (p0 + p1 * w) / (1 + w), c = (p2 + p1 * w) / (1 + w), m = (a + c) * 0.5;
  const double half = std::sqrt((1 + w) / 2);
  touch_arc(grid, cells, p0, a, m, half, depth - 1);
  touch_arc(grid, cells, m, c, p2, half, depth - 1);
}

/// Cells whose centre is nearer to the ellipse, in its own measure, than they reach.
void touch_ellipse(const Grid& grid, Cells& cells, const EllipsePiece& e) {
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const Box2 cell = grid.cell(i, j);
      const Vec2 d = cell.center() - e.center, half = cell.size() * 0.5;
      const double r = std::hypot(e.mxx * d.x + e.mxy * d.y, e.mxy * d.x + e.myy * d.y);
      const double reach = std::hypot(std::abs(e.mxx) * half.x + std::abs(e.mxy) * half.y, std::abs(e.mxy) * half.x + std::abs(e.myy) * half.y);
      if (std::abs(r - 1) <= reach) cells[static_cast<std::size_t>(j * kCells + i)] = kTouched;
    }
}

/// Cells outside of the footprint or a plane count as touched.
void touch_bounds(const PartDps& part, const QuadricDp& dp, const Grid& grid, Cells& cells) {
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const Box2 cell = grid.cell(i, j);
      const Vec2 half = cell.size() * 0.5, c = cell.center();
      bool inside = true;
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec2 a = dp.footprint[k], d = dp.footprint[(k + 1) % 4] - a;
        const double slack = 1e-9 * (std::abs(d.x) + std::abs(d.y)) * (half.x + half.y);
        inside = inside && cross(d, c - a) >= std::abs(d.x) * half.y + std::abs(d.y) * half.x - slack;
      }
      for (std::uint32_t k = dp.first_plane; k < dp.first_plane + dp.planes; ++k) {
        const ClipPlane& plane = part.planes[k];
        inside = inside && plane.n.x * c.x + plane.n.y * c.y + plane.d >= std::abs(plane.n.x) * half.x + std::abs(plane.n.y) * half.y;
      }
      if (!inside) cells[static_cast<std::size_t>(j * kCells + i)] = kTouched;
    }
}

struct Range {
  int i0 = 0, j0 = 0, i1 = 0, j1 = 0;
  int area() const { return (i1 - i0) * (j1 - j0); }
};

/// Row by row, with how many inside cells stand on each column; every rectangle's top row is tried for each of its lowest columns.
Range largest(const Cells& cells) {
  Range best;
  std::array<int, kCells> height{};
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      int& h = height[static_cast<std::size_t>(i)];
      h = cells[static_cast<std::size_t>(j * kCells + i)] == kInside ? h + 1 : 0;
    }
    for (int i = 0; i < kCells; ++i) {
      int lowest = kCells;
      for (int k = i; k < kCells && height[static_cast<std::size_t>(k)] > 0; ++k) {
        lowest = std::min(lowest, height[static_cast<std::size_t>(k)]);
        const Range range{i, j + 1 - lowest, k + 1, j + 1};
        if (range.area() > best.area()) best = range;
      }
    }
  }
  return best;
}

}  // namespace

std::vector<Box2> inner_rectangles(const PartDps& part, const QuadricDp& dp) {
  Box2 box;
  for (const Vec2 c : dp.footprint) box.add(c);
  if (!(box.size().x > 0 && box.size().y > 0)) return {};
  const Grid grid(box);
  Cells cells{};
  touch_bounds(part, dp, grid, cells);
  for (std::uint32_t i = dp.first_line; i < dp.first_line + dp.lines; ++i) touch(grid, cells, {part.lines[i].p0, part.lines[i].p1});
  for (std::uint32_t i = dp.first_arc; i < dp.first_arc + dp.arcs; ++i) {
    const ArcPiece& a = part.arcs[i];
    touch_arc(grid, cells, a.p0, a.p1, a.p2, a.w, 2);
  }
  for (std::uint32_t i = dp.first_ellipse; i < dp.first_ellipse + dp.ellipses; ++i) touch_ellipse(grid, cells, part.ellipses[i]);
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      Cell& cell = cells[static_cast<std::size_t>(j * kCells + i)];
      if (cell == kUntouched && pieces_contain(part, dp, grid.cell(i, j).center())) cell = kInside;
    }
  std::vector<Box2> result;
  while (result.size() < kMostRectangles) {
    const Range r = largest(cells);
    if (r.area() < kFewestCells) break;
    result.push_back(grid.box(r.i0, r.j0, r.i1, r.j1));
    for (int j = r.j0; j < r.j1; ++j)
      for (int i = r.i0; i < r.i1; ++i) cells[static_cast<std::size_t>(j * kCells + i)] = kTouched;
  }
  return result;
}

}  // namespace dupin
