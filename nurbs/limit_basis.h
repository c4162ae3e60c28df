// Inside the folder: from control points of regular cages to Bézier patches.
#ifndef DUPIN_NURBS_LIMIT_BASIS_H
#define DUPIN_NURBS_LIMIT_BASIS_H

#include <array>

#include "limit_forest.h"

namespace dupin {

/// Of a uniform bicubic B-spline: control[4 · row + column], the patch between rows and columns 1 and 2, s
/// along columns.
LimitPatch from_bicubic_spline(const std::array<Vec3, 16>& control);

/// Points of the three-directional lattice around the triangle (0,0), (1,0), (0,1), on which a quartic box
/// spline depends.
inline constexpr std::array<std::array<int, 2>, 12> kLoopSupport{
    {{0, 0}, {1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}, {2, -1}, {2, 0}, {1, 1}, {0, 2}, {-1, 2}}};
/// control[i] stands at kLoopSupport[i].
LimitPatch from_box_spline(const std::array<Vec3, 12>& control);

/// The patch that has these values: of a bicubic at {0, ¼, ¾, 1}², values[4 i + j]; of a polynomial of total
/// degree 4 at (i/4, j/4), i + j <= 4, values[5 i + j].
LimitPatch bicubic_through(const std::array<Vec3, 16>& values);
LimitPatch quartic_through(const std::array<Vec3, 25>& values);

/// Bézier poles of the curve with these values at 0, ¼, ½, ¾, 1.
std::array<Vec3, 5> quartic_curve_through(const std::array<Vec3, 5>& values);

}  // namespace dupin

#endif
