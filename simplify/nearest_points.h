// The points nearest to a place.
#ifndef DUPIN_SIMPLIFY_NEAREST_POINTS_H
#define DUPIN_SIMPLIFY_NEAREST_POINTS_H

#include <cstdint>
#include <memory>
#include <vector>

#include "../core/vec.h"

namespace dupin {

class NearestPoints {
 public:
  /// `points` must outlive this.
  explicit NearestPoints(const std::vector<Vec3>& points);
  ~NearestPoints();
  /// Up to `count` indices, nearest first. May be called from several threads.
  std::vector<std::uint32_t> find(const Vec3& place, std::size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace dupin

#endif
