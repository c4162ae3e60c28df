// A hierarchy of boxes for finding what a line may meet, nearest first.
#ifndef DUPIN_EXACT_BVH_H
#define DUPIN_EXACT_BVH_H

#include <cstdint>
#include <functional>
#include <vector>

#include "../core/vec.h"
#include "patch_ray.h"

namespace dupin::exact {

class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(const std::vector<Box3>& boxes);

  /// Calls visit(i) for every box that the line meets at a parameter in [least, most], roughly from the
  /// nearest on. The visitor returns the new `most`: what lies beyond is left out from then on.
  void traverse(const Line& line, double least, double most,
                const std::function<double(std::uint32_t)>& visit) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t first = 0, count = 0;  ///< a leaf's items; count 0: children at first and first + 1
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count, const std::vector<Box3>& boxes);
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  std::vector<Box3> boxes_;  ///< of the items, in their order
};

}  // namespace dupin::exact

#endif
