// Rational surfaces: Bézier patches cut into nearly flat cells.
#include <algorithm>
#include <cmath>

#include "../nurbs/bounds.h"
#include "surface_caster.h"

namespace dupin::exact {
namespace {

constexpr double kFlat = 0.05;  // of a cell's diagonal
constexpr int kMaxCuts = 10;

/// Largest second differences of the control net, along u and v, and its twist.
Vec2 bend(const BezierPatch& patch) {
  const auto point = [&](int i, int j) {
    const Vec4& p = patch.pole(i, j);
    return Vec3{p.x, p.y, p.z} / p.w;
  };
  Vec2 bend;
  for (int i = 0; i <= patch.degree_u; ++i)
    for (int j = 0; j <= patch.degree_v; ++j) {
      const double s = patch.degree_u ? double(i) / patch.degree_u : 0,
                   t = patch.degree_v ? double(j) / patch.degree_v : 0;
      const Vec3 along_u = point(0, j) * (1 - s) + point(patch.degree_u, j) * s,
                 along_v = point(i, 0) * (1 - t) + point(i, patch.degree_v) * t;
      bend.x = std::max(bend.x, distance(point(i, j), along_u));
      bend.y = std::max(bend.y, distance(point(i, j), along_v));
    }
  return bend;
}

class PatchCaster : public SurfaceCaster {
 public:
  PatchCaster(const Surface& surface, const std::vector<BezierPatch>& patches) : surface_(surface) {
    Box3 all;
    for (const BezierPatch& patch : patches) all.add(bounding_box(patch));
    extent_ = all.diagonal();
    for (const BezierPatch& patch : patches) add(patch, 0);
  }

  void meet(std::size_t index, const Line& line, std::vector<Crossing>& out) const override {
    const Cell& cell = cells_[index];
    // Coordinates relative to a point beside the cell keep their digits.
    const double t0 =
        dot(boxes_[index].center() - line.origin, line.direction) / dot(line.direction, line.direction);
    const Line near{line.origin + line.direction * t0, line.direction};
    thread_local std::vector<Vec2> roots;
    roots.clear();
    exact::meet(cell.poles, near, roots);
    for (const Vec2& root : roots) {
      Crossing crossing{0, {patch_to_surface_u(cell.map, root.x), patch_to_surface_v(cell.map, root.y)}};
      if (!polish(surface_, near, cell.map.domain, kCrossingError * extent_ + rounding(line), crossing))
        continue;
      crossing.t += t0;
      out.push_back(crossing);
    }
  }

 private:
  struct Cell {
    PatchPoles poles;
    BezierPatch map;  ///< without poles: for its maps of parameters
  };
  /// Of coordinates far from the origin.
  static double rounding(const Line& line) { return 1e-14 * length(line.origin); }

  void add(const BezierPatch& patch, int cuts) {
    const Vec2 off = bend(patch);
    const Box3 box = bounding_box(patch);
    if (cuts < kMaxCuts && std::max(off.x, off.y) > kFlat * box.diagonal()) {
      const bool along_u = off.x >= off.y;
      add(along_u ? subpatch(patch, 0, 0.5, 0, 1) : subpatch(patch, 0, 1, 0, 0.5), cuts + 1);
      add(along_u ? subpatch(patch, 0.5, 1, 0, 1) : subpatch(patch, 0, 1, 0.5, 1), cuts + 1);
      return;
    }
    boxes_.push_back(box);
    cells_.push_back({patch_poles(patch), patch});
    cells_.back().map.poles.clear();
  }

  const Surface& surface_;
  double extent_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace

std::unique_ptr<SurfaceCaster> make_patch_caster(const Surface& surface, std::vector<BezierPatch> patches) {
  return std::make_unique<PatchCaster>(surface, patches);
}

}  // namespace dupin::exact
