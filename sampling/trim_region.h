// Which parameters of a face lie within its trims.
#ifndef DUPIN_SAMPLING_TRIM_REGION_H
#define DUPIN_SAMPLING_TRIM_REGION_H

#include <vector>

#include "../nurbs/model.h"

namespace dupin {

/// The face's loops as polygons (each smooth piece of a pcurve has kTrimSteps sides), or its box where it has
/// none.
inline constexpr int kTrimSteps = 24;

class TrimRegion {
 public:
  TrimRegion(const Part& part, const Face& face);
  const Box2& box() const { return box_; }
  /// Even–odd. A point on the box's border counts as just within it.
  bool contains(Vec2 uv) const;
  enum class Overlap { outside, inside, crossing };
  Overlap overlap(const Box2& cell) const;

 private:
  struct Segment {
    Vec2 a, b;
  };
  std::size_t bin(double v) const;
  Vec2 nudged(Vec2 uv) const;

  Box2 box_;
  bool whole_ = true;
  std::vector<std::vector<Segment>> bins_;  ///< by v; a segment is in every bin that it passes
};

/// The pieces of a surface over `region` that are smooth inside: knot spans, arcs of at most a right angle.
std::vector<Box2> parameter_patches(const Surface& surface, const Box2& region);

}  // namespace dupin

#endif
