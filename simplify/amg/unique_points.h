// Points without duplicates, in an order that keeps neighbors near in memory.
#ifndef DUPIN_SIMPLIFY_AMG_UNIQUE_POINTS_H
#define DUPIN_SIMPLIFY_AMG_UNIQUE_POINTS_H

#include "../surface_points.h"

namespace dupin::amg {

/// Points nearer than about this part of the extent are one.
inline constexpr double kMergeFraction = 1.0 / (1U << 30);

struct UniquePoints {
  std::vector<Vec3> positions;           ///< relative to the middle of their box, in `extent`s
  std::vector<Vec3> normals;             ///< unit or zero; as many as positions, or none
  std::vector<std::uint32_t> unique_of;  ///< for each of the original points
  std::vector<std::uint32_t> triangles;  ///< without those that merging made degenerate
  std::vector<std::uint32_t> loose;      ///< points that no triangle uses, ascending; all of a point set
  double extent = 0;                     ///< largest side of their box; 0 where points cannot be told apart
};

/// Points of a mesh are merged wherever they coincide; those of a point set only with others of their sheet.
UniquePoints unique_points(const SurfacePoints& points);

}  // namespace dupin::amg

#endif
