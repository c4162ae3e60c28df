// Surfaces without a Bézier form: cells in which the normal hardly turns, searched by Newton's method.
//
// Offset surfaces: the base's patches bound the cells, moved along their normal cones. Sweeps of hyperbolas
// and of offset curves: 5 × 5 samples bound a cell, with a margin; these boxes are estimates.
#include <algorithm>
#include <array>
#include <cmath>

#include "../nurbs/bounds.h"
#include "surface_caster.h"

namespace dupin::exact {
namespace {

constexpr double kTurn = 0.1;  // radians, over a cell
constexpr int kMaxCuts = 14, kSamples = 5;
constexpr double kMargin = 0.25;  // of a sampled cell's diagonal

Box3 grown(Box3 box, double by) {
  box.lo -= Vec3{by, by, by};
  box.hi += Vec3{by, by, by};
  return box;
}

class SampledCaster : public SurfaceCaster {
 public:
  SampledCaster(const Surface& surface, const Box2& region) : surface_(surface), domain_(region) {
    if (const auto* offset = std::get_if<OffsetSurface>(&surface.geometry))
      for (const BezierPatch& patch : bezier_patches(*offset->base, region)) add(patch, offset->distance, 0);
    if (boxes_.empty()) add(region, 0);
    Box3 all;
    for (const Box3& box : boxes_) all.add(box);
    extent_ = all.diagonal();
  }

  bool complete() const override { return false; }

  void meet(std::size_t index, const Line& line, std::vector<Crossing>& out) const override {
    const double t0 =
        dot(boxes_[index].center() - line.origin, line.direction) / dot(line.direction, line.direction);
    const Line near{line.origin + line.direction * t0, line.direction};
    const Box2& cell = cells_[index];
    const double tolerance = kCrossingError * extent_ + 1e-14 * length(line.origin);
    for (const Vec2 start :
         {Vec2{0.5, 0.5}, Vec2{0.15, 0.15}, Vec2{0.85, 0.15}, Vec2{0.15, 0.85}, Vec2{0.85, 0.85}}) {
      Crossing crossing{0, {cell.lo.x + cell.size().x * start.x, cell.lo.y + cell.size().y * start.y}};
      // A step may leave the cell on its way to a root inside.
      const Vec2 room = cell.size();
      Box2 limits{cell.lo - room, cell.hi + room};
      limits.lo = {std::max(limits.lo.x, domain_.lo.x), std::max(limits.lo.y, domain_.lo.y)};
      limits.hi = {std::min(limits.hi.x, domain_.hi.x), std::min(limits.hi.y, domain_.hi.y)};
      if (!polish(surface_, near, limits, tolerance, crossing)) continue;
      crossing.t += t0;
      out.push_back(crossing);
    }
  }

 private:
  void add(const BezierPatch& base, double distance, int cuts) {
    const NormalCone cone = normal_cone(base);
    const Vec2 bend = base.domain.size();
    if (cuts < kMaxCuts && (!cone.bounded() || cone.angle > kTurn)) {
      // In turn: the cone does not say which direction turns it.
      const bool along_u = cuts % 2 == 0 && bend.x > 0;
      add(along_u ? subpatch(base, 0, 0.5, 0, 1) : subpatch(base, 0, 1, 0, 0.5), distance, cuts + 1);
      add(along_u ? subpatch(base, 0.5, 1, 0, 1) : subpatch(base, 0, 1, 0.5, 1), distance, cuts + 1);
      return;
    }
    Box3 box = bounding_box(base);
    if (cone.bounded()) {
      box.lo += cone.axis * distance;
      box.hi += cone.axis * distance;
      box = grown(box, std::abs(distance) * 2 * std::sin(cone.angle / 2));
    } else {
      box = grown(box, std::abs(distance));
    }
    boxes_.push_back(box);
    cells_.push_back(base.domain);
  }

  void add(const Box2& cell, int cuts) {
    Box3 box;
    double turn = 0;
    Vec3 first;
    for (int i = 0; i < kSamples; ++i)
      for (int j = 0; j < kSamples; ++j) {
        const SurfaceJet jet = evaluate(surface_, cell.lo.x + cell.size().x * i / (kSamples - 1),
                                        cell.lo.y + cell.size().y * j / (kSamples - 1), 1);
        if (!is_finite(jet.p)) continue;
        box.add(jet.p);
        const Vec3 n = normalized(cross(jet.pu, jet.pv));
        if (length(first) == 0) first = n;
        if (length(n) > 0) turn = std::max(turn, length(n - first));
      }
    if (cuts < kMaxCuts && turn > kTurn) {
      Box2 lower = cell, upper = cell;
      const int axis = cuts % 2;
      lower.hi[axis] = upper.lo[axis] = cell.center()[axis];
      add(lower, cuts + 1);
      add(upper, cuts + 1);
      return;
    }
    boxes_.push_back(grown(box, kMargin * box.diagonal()));
    cells_.push_back(cell);
  }

  const Surface& surface_;
  Box2 domain_;
  double extent_ = 0;
  std::vector<Box2> cells_;
};

}  // namespace

std::unique_ptr<SurfaceCaster> make_sampled_caster(const Surface& surface, const Box2& region) {
  return std::make_unique<SampledCaster>(surface, region);
}

}  // namespace dupin::exact
