// The star of one point in the Delaunay triangulation of points of the plane: all that a fan needs of it.
#ifndef DUPIN_SIMPLIFY_AMG_STAR_H
#define DUPIN_SIMPLIFY_AMG_STAR_H

#include <cstdint>
#include <vector>

#include "../../core/vec.h"

namespace dupin::amg {

/// Whole coordinates relative to the star's centre, which is (0, 0): |x|, |y| <= kStarRange. With these every
/// predicate is exact in 64 bits.
struct StarPoint {
  std::int64_t x = 0, y = 0;
  std::uint32_t index = 0;
};
inline constexpr double kStarRange = 1 << 14;

/// A cycle of the centre's neighbors, counter-clockwise; the fan has a triangle between each and the next
/// where they are less than half a turn apart.
struct Star {
  std::vector<StarPoint> points;
  bool closed = false;  ///< there is a triangle between every two
};

/// Of `points` (any order; changed); those at the centre are ignored, and of several in one direction only
/// the nearest can take part. Four on a circle: any of the two triangulations.
void delaunay_star(std::vector<StarPoint>& points, Star& star);

/// Whether going from a to b, counter-clockwise about the centre, is less than half a turn.
inline bool less_than_half_turn(const StarPoint& a, const StarPoint& b) {
  return a.x * b.y - a.y * b.x > 0;
}

/// The square of the largest diameter of circles around the star's triangles: points that are farther than
/// that cannot change a closed star. Rounded; infinite for one that is not closed.
double squared_reach(const Star& star);

}  // namespace dupin::amg

#endif
