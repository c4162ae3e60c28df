// Differential points at the vertices of a polygon mesh.
#ifndef DUPIN_SAMPLING_MESH_POINTS_H
#define DUPIN_SAMPLING_MESH_POINTS_H

#include "differential_point.h"

namespace dupin {

/// What of a mesh has no point of its own.
struct MeshPointLosses {
  std::size_t loose_vertices = 0;  ///< no polygon uses them, so that they lie on no surface
  std::size_t flat_triangles = 0;  ///< without area: no normal, and no weight in any tensor
  std::size_t lost_vertices = 0;   ///< all of their triangles are without area
  std::size_t split_vertices = 0;  ///< at creases: they have a point for each smooth side
};

enum class MeshCurvature {
  /// Taubin's tensor ("Estimating the tensor of curvature of a surface from a polyhedral approximation", ICCV
  /// 1995): the edges' normal curvatures summed up by their directions, weighted by the area of their
  /// triangles. Right for edges that are spread evenly around a vertex; on a grid of triangles it is off by a
  /// quarter of the larger curvature, however fine the grid.
  taubin,
  /// The tensor that fits the same normal curvatures best, by least squares with the same weights: on a
  /// quadratic surface the surface's own. Taubin's where edges lie in fewer than three directions.
  fitted,
};

struct MeshPointOptions {
  MeshCurvature curvature = MeshCurvature::fitted;
  double epsilon = 0.012, delta = 0;  ///< δ = 0: rectangles are only as large as edges and triangles ask
  std::uint32_t first_face = 0;       ///< added to a polygon's group for its face
  /// A vertex where triangles meet at kCreaseDegrees or more (mesh_triangles.h), or turn opposite ways, gets
  /// a point for each smooth fan of them; the papers: one point a vertex.
  bool split_creases = true;
  /// Rectangles also hold the centroids of their triangles, which the middles of edges may leave uncovered;
  /// the papers: not.
  bool hold_centroids = true;
};
/// As published.
MeshPointOptions papers_mesh_options();

/// Rectangles are those of ε and δ, enlarged to hold the middles of the edges, projected along the mean
/// normal of an edge's triangles (Kalaiah & Varshney 2003, section IV-B).
///
/// Vertices at the same place are one. Edges may have any number of triangles. Polygons are triangulated.
/// Edges between points are those of the mesh.
PartPoints mesh_points(const PolygonMesh& mesh, const MeshPointOptions& options, MeshPointLosses& losses);

}  // namespace dupin

#endif
