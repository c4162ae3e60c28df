// Inside the folder: what stands for the limit around extraordinary vertices, and how far it is off.
#ifndef DUPIN_NURBS_LIMIT_CAPS_H
#define DUPIN_NURBS_LIMIT_CAPS_H

#include "bezier.h"
#include "limit_forest.h"

namespace dupin {

/// An interpolant (limit_forest.h) in a node's place.
struct LimitCap {
  std::uint32_t node = 0;
  LimitPatch patch;
  /// Certified: by differences of control points on every exact piece below the node, and by the control
  /// points' hull on what is left at the last level.
  double deviation = 0;
  /// Likewise, on the exact pieces; radians.
  double normal_deviation = 0;
  double size = 0;  ///< the diagonal of its poles' box
};

/// Boxes that hold the limit around the vertices of what is irregular to the last.
class CapHulls {
 public:
  explicit CapHulls(const LimitForest& forest);
  const Box3& around(std::size_t level, std::uint32_t vertex) const { return levels_[level][vertex]; }
  /// Everything is regular in the end.
  bool empty() const {
    for (const auto& level : levels_)
      if (!level.empty()) return false;
    return true;
  }

 private:
  std::vector<std::vector<Box3>> levels_;
};

LimitCap make_cap(const LimitForest& forest, const CapHulls& hulls, std::uint32_t node);

/// The surface as leaves that are regular and caps of one level, the first at which all are good enough, or
/// `deepest`.
struct LimitCover {
  std::vector<std::uint32_t> regular;  ///< nodes
  std::vector<LimitCap> caps;
};
LimitCover make_cover(const LimitForest& forest, double diagonal, const LimitPartOptions& options,
                      int deepest);

/// Squares that cover s + t <= 1 and little more.
std::vector<Box2> squares_of_triangle();

/// A patch over local parameters as others have it.
BezierPatch to_bezier(const LimitPatch& patch);

}  // namespace dupin

#endif
