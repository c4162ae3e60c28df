// A mesh's vertices as QSplat's leaves, and points without a mesh.
#ifndef DUPIN_SIMPLIFY_LEAF_POINTS_H
#define DUPIN_SIMPLIFY_LEAF_POINTS_H

#include <vector>

#include "bounding_sphere.h"
#include "tree_mesh.h"

namespace dupin {

struct LeafPoint {
  Sphere sphere;  ///< in grid steps
  Vec3 normal;    ///< unit
  Vec3 cone_axis;
  double cone_half_angle =
      4;  ///< around all polygons' normals; more than a right angle if they may be seen from behind
  double weight = 1;
  Rgba8 color{255, 255, 255, 255};
  std::uint32_t group = 0;
};

/// One for each place that triangles have a corner at, with spheres that are large enough for those of
/// neighbours to touch (Rusinkiewicz & Levoy 2000, section 3.1). For a mesh without polygons one for each
/// place, with spheres that reach the third nearest other, and normals across the nearest ones where the file
/// has none. `grid_positions`: of every vertex.
std::vector<LeafPoint> leaf_points(const TreeMesh& mesh, const std::vector<Vec3>& grid_positions);

}  // namespace dupin

#endif
