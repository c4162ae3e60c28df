// Nearest neighbors in space. The tree (nanoflann) is behind neighbors.cpp.
#ifndef DUPIN_SIMPLIFY_AMG_NEIGHBOURS_H
#define DUPIN_SIMPLIFY_AMG_NEIGHBOURS_H

#include <cstdint>
#include <memory>
#include <vector>

#include "../../core/vec.h"

namespace dupin::amg {

struct Neighbor {
  std::uint32_t index = 0;
  double squared_distance = 0;
};
/// Nearer first, and at the same distance by index.
inline bool nearer(const Neighbor& a, const Neighbor& b) {
  return a.squared_distance < b.squared_distance ||
         (a.squared_distance == b.squared_distance && a.index < b.index);
}

class NeighborTree {
 public:
  /// `points` must outlive the tree.
  explicit NeighborTree(const std::vector<Vec3>& points);
  ~NeighborTree();

  /// The `count` nearest of `point`, itself included if it is one of the tree's, and all others within
  /// `radius`, in no order. `guess`, the squared radius that held as many around the last point asked for (0:
  /// unknown), only makes it faster: near points have near answers. Returns the square of the largest
  /// distance.
  double nearest(const Vec3& point, std::size_t count, double radius, double& guess,
                 std::vector<Neighbor>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace dupin::amg

#endif
