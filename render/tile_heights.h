// Where a curved DP's surface lies above a part of its (x, y).
#ifndef DUPIN_RENDER_TILE_HEIGHTS_H
#define DUPIN_RENDER_TILE_HEIGHTS_H

#include <array>

#include "../sampling/quadric_dp.h"

namespace dupin {

struct Interval {
  double lo, hi;
  bool empty() const { return !(lo <= hi); }
};

/// Where F = 0 lies above a rectangle of (x, y), between the ends: up to two intervals of z.
struct Heights {
  Interval z[2];
  int count = 0;
};
Heights heights(const QuadricDp& dp, const Box2& box, const Interval& ends);

/// A body that holds a part of the surface.
struct Hull {
  std::array<Vec3, 8> points;  ///< 0–3 below the corners, 4–7 above them
  double thickness = 0;        ///< across the surface
  bool slanting = false;       ///< it lies along the tangent plane in the middle
};
/// Of what is above the convex quadrilateral and within z. `box` is the corners'.
Hull hull_of(const QuadricDp& dp, const std::array<Vec2, 4>& corners, const Box2& box, const Interval& z);

}  // namespace dupin

#endif
