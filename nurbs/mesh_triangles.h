// A polygon mesh as triangles, with the normals that it is shaded by.
#ifndef DUPIN_NURBS_MESH_TRIANGLES_H
#define DUPIN_NURBS_MESH_TRIANGLES_H

#include <cstdint>
#include <vector>

#include "model.h"
#include "polygon_mesh.h"

namespace dupin {

/// Polygons that meet at a smaller angle are shaded as one smooth surface where a file has no normals: more
/// than the 30° that tessellations of round faces use, less than a chamfer's 45°.
inline constexpr double kCreaseDegrees = 40;

/// Three each, indices into PolygonMesh::corners, in the polygon's own direction; a polygon's triangles
/// follow each other. Convex polygons are cut as a fan, concave ones by ears in their plane of largest
/// extent; one that is not simple, or needs more than kEarTests tests a corner, ends as a fan.
std::vector<std::uint32_t> triangulate(const PolygonMesh& mesh);
inline constexpr int kEarTests = 256;

/// Which polygon each triangle of `triangulate` came from; triangle i from polygon i where all are triangles.
std::vector<std::uint32_t> triangle_polygons(const PolygonMesh& mesh);

/// Twice the area vector of a polygon (Newell's): its direction is the normal of the plane that fits it, even
/// where it is not flat or not convex; zero for a degenerate one.
Vec3 area_vector(const PolygonMesh& mesh, std::size_t polygon);

/// A unit normal for each corner: the file's where it has one, else the mean of the polygons around the
/// vertex that meet this one at less than kCreaseDegrees, weighted by their angles there. Zero where all of
/// them are degenerate.
std::vector<std::array<float, 3>> corner_normals(const PolygonMesh& mesh);

/// For drawing: vertices split where corners differ in their normal, positions relative to `origin`, and in
/// `faces` the group of each triangle.
TriangleMesh to_triangle_mesh(const PolygonMesh& mesh, const Vec3& origin);

}  // namespace dupin

#endif
