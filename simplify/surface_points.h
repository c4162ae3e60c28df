// Points of a surface, as decompositions start from them: the vertices of a mesh, a scan, or samples of an
// exact face.
#ifndef DUPIN_SIMPLIFY_SURFACE_POINTS_H
#define DUPIN_SIMPLIFY_SURFACE_POINTS_H

#include <cstdint>
#include <vector>

#include "../core/status.h"
#include "../core/vec.h"

namespace dupin {

/// Every list but `positions` may be empty. Points may coincide, lie on a line, or be alone.
struct SurfacePoints {
  std::vector<Vec3> positions;           ///< in the part's space
  std::vector<Vec3> normals;             ///< unit, outward; zero where unknown
  std::vector<std::uint32_t> colors;     ///< sRGB, 8 bits each, r lowest; 0: the face's or the part's
  std::vector<std::uint32_t> faces;      ///< index of each point's face in the part; empty: all of face 0
  std::vector<std::uint32_t> triangles;  ///< three indices each; points without triangles are a point set
  bool is_mesh() const { return !triangles.empty(); }
  std::size_t size() const { return positions.size(); }
};

/// As many points as one decomposition is meant for.
inline constexpr std::size_t kMostSourcePoints = 20'000'000;

/// ok if every list is of the right length, every index in range and every number finite; else what is wrong.
Status check(const SurfacePoints& points);

/// Whether two outward normals can belong to one sheet of a surface: not those of a thin plate's two sides.
/// Unknown (zero) normals can.
inline constexpr double kSameSheetCosine = -0.5;
inline bool same_sheet(const Vec3& a, const Vec3& b) {
  return dot(a, b) > kSameSheetCosine;
}

}  // namespace dupin

#endif
