// Inside the folder: a limit surface as a Part.
#ifndef DUPIN_NURBS_LIMIT_PART_H
#define DUPIN_NURBS_LIMIT_PART_H

#include "limit_caps.h"
#include "model.h"

namespace dupin {

Part make_limit_part(const LimitForest& forest, const PolygonMesh& cage, double diagonal,
                     const LimitPartOptions& options);

/// How often polygons are cut for so many segments an edge, if that makes not too many triangles.
int tessellation_levels(const PolygonMesh& cage, int segments, std::size_t most_triangles);
/// Triangles by uniform refinement; `face_of` gives the face that each node is (part of).
TriangleMesh tessellate_limit(const LimitForest& forest, const PolygonMesh& cage,
                              const std::vector<std::uint32_t>& face_of, int levels);

}  // namespace dupin

#endif
