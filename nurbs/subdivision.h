// The limit surfaces of Catmull–Clark and Loop cages, exact: as faces of a Part, and point by point.
//
// Away from extraordinary vertices and semi-sharp creases the limit is a bicubic B-spline (Catmull–Clark) or
// a quartic box spline (Loop). A polygon of the cage is one such patch, or it is cut in four until its pieces
// are. What is left around an extraordinary vertex after `levels` cuts is 4^-levels of a polygon.
//
// Topology and refinement are OpenSubdiv's: its scheme, creases, corners, holes and boundaries
// (SubdivisionTags). Sources: E. Catmull, J. Clark, CAD 10(6), 1978; C. Loop, 1987; M. Nießner et al., ACM
// TOG 31(1), 2012.
#ifndef DUPIN_NURBS_SUBDIVISION_H
#define DUPIN_NURBS_SUBDIVISION_H

#include <cstdint>
#include <memory>

#include "../core/status.h"
#include "model.h"
#include "polygon_mesh.h"

namespace dupin {

enum class SubdivisionScheme : std::uint8_t {
  automatic,  ///< Loop where all polygons are triangles, else Catmull–Clark
  catmull_clark,
  loop  ///< only for triangles
};

/// The deepest cut.
inline constexpr int kMaxSubdivisionLevels = 15;

struct SubdivisionOptions {
  SubdivisionScheme scheme = SubdivisionScheme::automatic;
  /// How often polygons are cut towards what is not regular, 3 … kMaxSubdivisionLevels. 0: as often as `part`
  /// needs for its tolerances, within a million pieces; where many sharp semi-sharp creases would need more,
  /// see SharpenedCreases.
  int levels = 0;
};

/// Creases that were taken for infinitely sharp: an approximation. One of sharpness s is rounded over about
/// 2^-s of its polygons.
struct SharpenedCreases {
  int count = 0;
  double sharpness = 0;  ///< the least of theirs, or somewhat less
};

/// How a Part is made of a limit surface. What no spline represents, the last pieces around extraordinary
/// vertices, may be off by the first two.
struct LimitPartOptions {
  double position_tolerance = 1e-5;  ///< as a part of the cage's diagonal
  double normal_tolerance = 2e-3;    ///< radians
  double least_size = 5e-5;  ///< pieces smaller than this part of the diagonal are not cut for their normals
  /// Part::mesh too: triangles on the limit surface by uniform refinement, which uses none of the patches. So
  /// many along an edge of the cage, rounded up to a power of 2, or fewer where that makes more than
  /// `most_triangles`. Faces are then no smaller than those.
  int segments_per_edge = 0;
  std::size_t most_triangles = 4'000'000;
};

/// A point of the limit surface.
struct LimitJet {
  SurfaceJet jet;
  /// False within the last pieces around an extraordinary vertex: a bicubic (quartic) interpolant stands for
  /// them, with derivatives that do not converge to the limit's.
  bool exact = true;
};

class SubdivisionSurface {
 public:
  /// Refuses what OpenSubdiv refuses, and Loop for other polygons than triangles.
  static Result<SubdivisionSurface> make(const PolygonMesh& cage, const SubdivisionOptions& options = {});
  SubdivisionSurface(SubdivisionSurface&&) noexcept;
  SubdivisionSurface& operator=(SubdivisionSurface&&) noexcept;
  ~SubdivisionSurface();

  SubdivisionScheme scheme() const;
  int levels() const;
  SharpenedCreases sharpened() const { return sharpened_; }

  /// Position and derivatives to `order` (0 … 3). Quads: (u, v) in [0,1]², (0,0) the polygon's first vertex,
  /// (1,0) the second, (0,1) the last. Triangles under Loop: u, v >= 0, u + v <= 1, likewise. Other polygons
  /// under Catmull–Clark are as many quads as they have corners: u in [i, i+1) is the i-th, its own first
  /// vertex the polygon's i-th. A hole has no points: not finite.
  LimitJet evaluate(std::size_t polygon, double u, double v, int order) const;
  /// Where curvature has no limit, at extraordinary vertices, and where no exact piece is left: undefined.
  Curvature curvature(std::size_t polygon, double u, double v) const;
  /// The limit normal at a polygon's corner, extraordinary or not; zero where there is none (a sharp tip).
  Vec3 corner_normal(std::size_t polygon, std::size_t corner) const;

  /// The surface as exact faces, one for each piece, with edges that neighbours share: those on infinitely
  /// sharp creases and boundaries are feature lines. Around extraordinary vertices interpolants stand for the
  /// last pieces: Face::recognized holds their own surface and how far that is off, certified.
  Part part(const LimitPartOptions& options = {}) const;

 private:
  class Impl;
  explicit SubdivisionSurface(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
  SharpenedCreases sharpened_;
};

}  // namespace dupin

#endif
