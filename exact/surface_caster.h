// Where a line meets an untrimmed surface: closed forms for analytic kinds, subdivided Bézier patches for all
// rational ones, Newton's method from small cells for offsets.
#ifndef DUPIN_EXACT_SURFACE_CASTER_H
#define DUPIN_EXACT_SURFACE_CASTER_H

#include <memory>
#include <vector>

#include "../core/vec.h"
#include "../nurbs/surface.h"
#include "patch_ray.h"

namespace dupin::exact {

/// A point of the surface on the line: origin + t · direction = S(uv) to rounding.
struct Crossing {
  double t = 0;
  Vec2 uv;
};

class SurfaceCaster {
 public:
  virtual ~SurfaceCaster() = default;
  /// One a cell: together they contain the surface over the region.
  const std::vector<Box3>& boxes() const { return boxes_; }
  /// Appends the crossings of one cell; they may lie a little beyond it, or be found by its neighbour too.
  virtual void meet(std::size_t cell, const Line& line, std::vector<Crossing>& out) const = 0;
  /// Whether every crossing is found, but where a line touches the surface. Not so for offsets and for sweeps
  /// of hyperbolas and of offset curves, whose cells are searched from a few starts each.
  virtual bool complete() const { return true; }

 protected:
  std::vector<Box3> boxes_;
};

/// `surface` must outlive it; the region is finite.
std::unique_ptr<SurfaceCaster> make_caster(const Surface& surface, const Box2& region);

/// Newton's method for S(uv) on the line, from uv. False if it did not come within `tolerance` of the line,
/// or left the limits.
bool polish(const Surface& surface, const Line& line, const Box2& limits, double tolerance,
            Crossing& crossing);
/// Largest distance of a polished point from its line, times the extent of the surface.
inline constexpr double kCrossingError = 1e-12;

// The kinds, each in its own file.
std::unique_ptr<SurfaceCaster> make_analytic_caster(const Surface& surface, const Box2& region);
std::unique_ptr<SurfaceCaster> make_patch_caster(const Surface& surface, std::vector<BezierPatch> patches);
std::unique_ptr<SurfaceCaster> make_sampled_caster(const Surface& surface, const Box2& region);

}  // namespace dupin::exact

#endif
