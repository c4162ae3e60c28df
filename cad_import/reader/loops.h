// From a wire's edges to loops that are closed in the parameter plane.
#ifndef DUPIN_CAD_IMPORT_READER_LOOPS_H
#define DUPIN_CAD_IMPORT_READER_LOOPS_H

#include <cstdint>
#include <string>
#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

/// One use of an edge by a wire. `from` and `to` are vertices in the direction in which the wire runs.
struct EdgeUse {
  Trim trim;
  double t0 = 0, t1 = 0;
  int from = -1, to = -1;
  double tolerance = 0;  ///< the edge's and its vertices'
  Vec2 file_start,
      file_end;  ///< where the file's own pcurve runs from and to: it knows on which side of a seam
  bool file_wrong = false;  ///< the file's pcurve lay far off: only the order of the wire is left to go by
  Vec2 start() const { return point_at(trim.pcurve, trim.reversed ? t1 : t0); }
  Vec2 end() const { return point_at(trim.pcurve, trim.reversed ? t0 : t1); }
};

/// A use whose edge index is this stands for a collapsed side that the file left out; its edge is to be made.
inline constexpr std::uint32_t kNewDegenerateEdge = 0xffffffffu;

struct WireLoops {
  std::vector<std::vector<EdgeUse>> loops;
  double gap = 0;        ///< the largest distance in space between one use's end and the next one's start
  bool winding = false;  ///< a loop closes only after whole periods: its seam is missing
};

/// Orders one wire's uses, moves their pcurves by whole periods so that they join, and closes gaps in
/// parameters that are larger than the tolerance by straight collapsed sides.
WireLoops assemble_loops(const Surface& surface, std::vector<EdgeUse> uses, double tolerance);

/// The part of a step in parameters that is whole turns of a periodic surface.
Vec2 whole_periods(const Surface& surface, Vec2 step);

/// Twice the area that a loop encloses in the parameter plane, positive when counter-clockwise.
double signed_area(const std::vector<EdgeUse>& loop);

}  // namespace dupin::reader

#endif
