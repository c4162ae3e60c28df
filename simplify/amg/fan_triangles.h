// The fans of loose points as triangles, each once.
#ifndef DUPIN_SIMPLIFY_AMG_FAN_TRIANGLES_H
#define DUPIN_SIMPLIFY_AMG_FAN_TRIANGLES_H

#include "neighborhoods.h"

namespace dupin::amg {

struct FanTriangles {
  std::vector<std::uint32_t> triangles;  ///< three points each; where fans differ they overlap
  std::vector<bool> rim;  ///< of each point: a loose one at an edge of one triangle only, or without any
};
FanTriangles fan_triangles(const UniquePoints& points, const Neighborhoods& around);

}  // namespace dupin::amg

#endif
