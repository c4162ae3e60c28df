// Rectangles well inside a planar DP's region: drawn first and without a test, they spare most pixels the walk along the boundary.
#ifndef DUPIN_RENDER_INNER_RECTANGLES_H
#define DUPIN_RENDER_INNER_RECTANGLES_H

#include <vector>

#include "../sampling/quadric_dp.h"

namespace dupin {

/// Axis-parallel in the DP's (x, y), disjoint, the largest first; none that is smaller than a fraction of the footprint. No boundary
/// piece, clip plane or side of the footprint reaches into them, and their points are drawn.
std::vector<Box2> inner_rectangles(const PartDps& part, const QuadricDp& dp);

}  // namespace dupin

#endif
