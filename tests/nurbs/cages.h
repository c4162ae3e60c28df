// Cages for tests, and Stam's evaluation of one extraordinary vertex by eigenvectors.
#ifndef DUPIN_TESTS_NURBS_CAGES_H
#define DUPIN_TESTS_NURBS_CAGES_H

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "../../nurbs/polygon_mesh.h"
#include "../../nurbs/surface.h"

namespace dupin::test {

PolygonMesh cage_of(std::vector<Vec3> positions, const std::vector<std::vector<std::uint32_t>>& polygons);
/// 8 vertices, 6 quads, outward.
PolygonMesh cube_cage();
PolygonMesh icosahedron_cage();
/// A torus of quads, or of triangles: regular everywhere.
PolygonMesh torus_cage(int around, int across, bool triangles, std::uint64_t seed);
/// An open strip of quads with a boundary, of triangles, or with pentagons at its end.
PolygonMesh grid_cage(int nu, int nv, bool triangles, std::uint64_t seed);

/// A vertex of any valence in the middle of a regular lattice of `radius` rings. Polygon 0 is at the vertex,
/// which is its first corner; it is a quad or a triangle.
class FanCage {
 public:
  FanCage(int valence, bool triangles, std::uint64_t seed);
  const PolygonMesh& mesh() const { return mesh_; }
  /// Jets of polygon 0's limit by Stam's method: the subdivision matrix's eigenvectors raise it to the power
  /// that (u, v) needs; order 2.
  SurfaceJet stam(double u, double v) const;

 private:
  /// A point of sector k's quadrant: i along its first spoke, j along the next sector's.
  using Place = std::tuple<int, int, int>;
  Place canonical(int k, int i, int j) const;
  Place step(const Place& from, int di, int dj) const;
  /// What a point of the next level is made of.
  std::map<Place, double> rule(const Place& fine) const;
  std::map<Place, double> vertex_rule(const Place& at) const;
  std::map<Place, Vec3> refined(const std::map<Place, Vec3>& coarse, const std::vector<Place>& wanted) const;
  std::vector<Place> support() const;

  static constexpr int kRadius = 3;
  int valence_;
  bool triangles_;
  PolygonMesh mesh_;
  std::map<Place, Vec3> control_;
};

}  // namespace dupin::test

#endif
