// How large a splat has to be.
#ifndef DUPIN_SAMPLING_BALL_RADIUS_H
#define DUPIN_SAMPLING_BALL_RADIUS_H

#include <vector>

#include "differential_point.h"

namespace dupin {

/// Of every point the radius of its bounding ball, "determined by comparing its distance from its sampled
/// neighbors" (Kalaiah & Varshney 2003, section VI): the farthest of the eight samples around it on its grid,
/// or of those that it shares an edge with. Squares of that width leave no hole between them, however the
/// grid lies to the picture. A sample that the trims left alone has its grid's largest, or where it is
/// the only one there the part's, but no more than its rectangle asks; points without grid or edges, and
/// every point of a pruned part, twice the half-diagonal of their rectangle.
std::vector<float> ball_radii(const PartPoints& part);

}  // namespace dupin

#endif
