// Polygons as a file has them: a scan, an export, or the control cage of a subdivision surface.
//
// A mesh is kept as it is: polygons of any size, in the file's order and orientation, may share vertices or
// not, may touch in any way (non-manifold edges, islands, doubles) and may be degenerate. Vertices that no
// polygon uses are points of their own. Lengths are the part's.
#ifndef DUPIN_NURBS_POLYGON_MESH_H
#define DUPIN_NURBS_POLYGON_MESH_H

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../core/status.h"
#include "../core/vec.h"
#include "color.h"

namespace dupin {

/// sRGB and straight alpha, 8 bits each, as mesh files have them.
using Rgba8 = std::array<std::uint8_t, 4>;

struct MeshGroup {
  std::string name;
  std::optional<Color> color;  ///< of its material
};

/// What a file says of a cage for its subdivision. Sharpness is OpenSubdiv's: 0 smooth, 10 and more
/// infinitely sharp.
struct SubdivisionTags {
  enum class Boundary : std::uint8_t { unsaid, none, edges_and_corners, edges };
  struct Crease {
    std::uint32_t a = 0, b = 0;  ///< vertices; not always an edge of the mesh
    float sharpness = 0;
  };
  struct Corner {
    std::uint32_t vertex = 0;
    float sharpness = 0;
  };
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<std::uint32_t> holes;  ///< polygons that are cut out of the limit surface
  Boundary boundary = Boundary::unsaid;
  bool chaikin = false;           ///< creases by Chaikin's rule
  bool smooth_triangles = false;  ///< Catmull–Clark with the weights for triangles
  bool empty() const {
    return creases.empty() && corners.empty() && holes.empty() && boundary == Boundary::unsaid;
  }
};

struct PolygonMesh {
  static constexpr std::uint32_t kNoNormal = 0xffffffffu;

  std::vector<Vec3> positions;
  std::vector<std::uint32_t> corners;  ///< the polygons' vertices, one polygon after the other
  /// Where each polygon begins in `corners`, and the end of the last; empty: every polygon is a triangle.
  std::vector<std::uint32_t> starts;

  /// Unit vectors, or zero where the file has none. One a vertex, unless `corner_normals` says otherwise.
  std::vector<std::array<float, 3>> normals;
  std::vector<std::uint32_t> corner_normals;  ///< per corner its index in `normals`, or kNoNormal; or empty

  std::vector<Rgba8> colors;          ///< one a vertex, or empty
  std::vector<Rgba8> polygon_colors;  ///< one a polygon, or empty

  /// Which groups there are, and each polygon's; `polygon_groups` is empty where all polygons are of the
  /// first.
  std::vector<MeshGroup> groups;
  std::vector<std::uint32_t> polygon_groups;

  SubdivisionTags tags;

  bool empty() const { return positions.empty(); }
  std::size_t polygon_count() const { return !starts.empty() ? starts.size() - 1 : corners.size() / 3; }
  std::size_t first_corner(std::size_t polygon) const {
    return starts.empty() ? 3 * polygon : starts[polygon];
  }
  std::size_t corner_count(std::size_t polygon) const {
    return starts.empty() ? 3 : starts[polygon + 1] - starts[polygon];
  }
  std::span<const std::uint32_t> polygon(std::size_t i) const {
    return {corners.data() + first_corner(i), corner_count(i)};
  }
  std::uint32_t group_of(std::size_t polygon) const {
    return polygon_groups.empty() ? 0 : polygon_groups[polygon];
  }
  bool all_triangles() const { return starts.empty(); }
};

/// How many triangles the polygons make: n − 2 each.
std::size_t triangle_count(const PolygonMesh& mesh);
/// What a part that is a mesh has in place of faces: its groups; 1 for polygons or points without groups. A
/// mesh that has groups alone is kept elsewhere (in a tree's file).
std::size_t face_count(const PolygonMesh& mesh);
/// Of every vertex, used or not.
Box3 bounding_box(const PolygonMesh& mesh);
/// Vertices that no polygon uses.
std::size_t loose_point_count(const PolygonMesh& mesh);
/// Drops `starts`, `corner_normals` and `polygon_groups` where they say nothing.
void simplify_layout(PolygonMesh& mesh);
/// ok if every index is in range, every list of the right length, every number finite and every polygon has
/// at least three corners; else the first thing that is wrong.
Status check(const PolygonMesh& mesh);

}  // namespace dupin

#endif
