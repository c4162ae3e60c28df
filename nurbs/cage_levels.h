// Inside the folder: a cage refined by OpenSubdiv, in plain arrays.
#ifndef DUPIN_NURBS_CAGE_LEVELS_H
#define DUPIN_NURBS_CAGE_LEVELS_H

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "polygon_mesh.h"
#include "subdivision.h"

namespace dupin {

inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// How a vertex moves at its level.
enum class VertexRule : std::uint8_t { smooth, dart, crease, corner };

/// The cage after some refinement. Adaptive refinement leaves out what is regular, but for what its
/// neighbours need.
struct CageLevel {
  std::vector<Vec3> points;
  std::vector<VertexRule> rules;
  std::vector<std::uint8_t> semi_sharp;  ///< by vertex: it or one of its edges is semi-sharp

  std::vector<std::uint32_t> face_starts, face_vertices, face_edges;  ///< edge i runs from vertex i to i + 1
  std::vector<std::uint8_t> hole;

  std::vector<std::array<std::uint32_t, 2>> edge_vertices;
  /// Both faces of an edge that the surface goes on across, smoothly or semi-sharply; else kNoIndex twice.
  std::vector<std::array<std::uint32_t, 2>> edge_faces;

  // The next level's; kNoIndex for what was not refined. Empty in the last level.
  std::vector<std::uint32_t> child_starts, child_faces;
  std::vector<std::array<std::uint32_t, 2>> edge_children;  ///< the half at edge_vertices[0] first

  std::size_t face_count() const { return face_starts.size() - 1; }
  std::span<const std::uint32_t> vertices(std::uint32_t face) const {
    return std::span(face_vertices).subspan(face_starts[face], face_starts[face + 1] - face_starts[face]);
  }
  std::span<const std::uint32_t> edges(std::uint32_t face) const {
    return std::span(face_edges).subspan(face_starts[face], face_starts[face + 1] - face_starts[face]);
  }
  std::span<const std::uint32_t> children(std::uint32_t face) const {
    if (child_starts.empty()) return {};
    return std::span(child_faces).subspan(child_starts[face], child_starts[face + 1] - child_starts[face]);
  }
};

struct CageLevels {
  SubdivisionScheme scheme = SubdivisionScheme::catmull_clark;
  std::vector<CageLevel> levels;
  /// Of the last level's vertices: where they go in the limit, and two tangents there.
  std::vector<Vec3> limits, tangents_u, tangents_v;
  /// The file's polygon of each face of the first level; polygons that use a vertex twice are left out.
  std::vector<std::uint32_t> polygons;
};

struct RefineOptions {
  SubdivisionScheme scheme = SubdivisionScheme::automatic;
  int levels = 0;
  bool adaptive = true;
};

Result<CageLevels> refine_cage(const PolygonMesh& cage, const RefineOptions& options);

/// Limits of the last level where one crease ends.
void correct_dart_limits(CageLevels& cage);

}  // namespace dupin

#endif
