// A polygon mesh as the point tree's builder sees it: triangles with everything that their leaves need.
#ifndef DUPIN_SIMPLIFY_TREE_MESH_H
#define DUPIN_SIMPLIFY_TREE_MESH_H

#include <array>
#include <cstdint>
#include <vector>

#include "../nurbs/polygon_mesh.h"

namespace dupin {

struct TreeMesh {
  explicit TreeMesh(const PolygonMesh& source);

  const PolygonMesh& source;
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< of each triangle, indices into source.corners
  std::vector<std::uint32_t> polygons;                ///< of each triangle; empty: triangle i is polygon i
  std::vector<std::array<float, 3>> normals;          ///< unit, one a corner of the source
  /// Per vertex one that stands for all at the same place: what joins triangles.
  std::vector<std::uint32_t> place;
  /// Per triangle: it is of a surface without border that has its inside behind it, so its back is never
  /// seen.
  std::vector<bool> closed;

  std::size_t size() const { return corners.size(); }
  std::uint32_t polygon(std::size_t triangle) const {
    return polygons.empty() ? static_cast<std::uint32_t>(triangle) : polygons[triangle];
  }
  std::uint32_t group(std::size_t triangle) const { return source.group_of(polygon(triangle)); }
  std::uint32_t vertex(std::size_t triangle, int k) const {
    return source.corners[corners[triangle][static_cast<std::size_t>(k)]];
  }
  const Vec3& position(std::size_t triangle, int k) const { return source.positions[vertex(triangle, k)]; }
  /// Twice the area, along the normal.
  Vec3 area_vector(std::size_t triangle) const {
    const Vec3 a = position(triangle, 0);
    return cross(position(triangle, 1) - a, position(triangle, 2) - a);
  }
  bool has_colors() const;
  /// The file's colour of a corner: its vertex's, else its polygon's, else its group's.
  Rgba8 color(std::size_t triangle, int k) const;
};

/// Which triangles belong to closed surfaces: every edge of the component runs as often one way as the other,
/// and the volume that it encloses is positive.
std::vector<bool> closed_triangles(const TreeMesh& mesh);

}  // namespace dupin

#endif
