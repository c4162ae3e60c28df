// The differential point of Kalaiah & Varshney, "Differential Point Rendering" (EGRW 2001) and "Modeling and
// Rendering of Points with Local Geometry" (TVCG 9(1), 2003): a sample of a surface with its principal frame
// and curvatures, and the flat rectangle in its tangent plane that stands for the surface around it.
//
// With x along û and y along v̂, the rectangle is |x| <= half_u, |y| <= half_v, where (2003, section IV-A)
//     half_u = min(δ, √(2ε − ε²) / |λu|),   half_v = min(δ, √(2ε − ε²) / |λv|).
// ε is the largest deviation of the osculating circles from the rectangle, in relation to their radii; δ a
// length.
#ifndef DUPIN_SAMPLING_DIFFERENTIAL_POINT_H
#define DUPIN_SAMPLING_DIFFERENTIAL_POINT_H

#include <cstdint>
#include <vector>

#include "../core/vec.h"
#include "../nurbs/model.h"

namespace dupin {

struct DifferentialPoint {
  Vec3 position;                      ///< in the part's space
  Vec3 u{1, 0, 0}, v{0, 1, 0};        ///< principal directions: unit, perpendicular, u × v outward
  double lambda_u = 0, lambda_v = 0;  ///< |λu| >= |λv|; positive where the surface bends towards u × v
  double half_u = 0, half_v = 0;
  Vec2 uv;  ///< the surface's parameters
  /// Of a certified point: how far its quadric is from the surface, at most. Of others, not certified: how
  /// far the osculating circles in the principal directions are from the rectangle at its edges.
  double bound = 0;
  std::uint32_t face = 0;  ///< index in the part
  /// The rectangle is not the one that ε and δ make (adaptive and certified points, some of a mesh's
  /// vertices).
  bool own_size = false;

  Vec3 n() const { return cross(u, v); }
  /// λv / λu, in [-1, 1]; 0 for a plane.
  double rho() const { return lambda_u != 0 ? lambda_v / lambda_u : 0; }
};

/// min(δ, √(2ε − ε²) / |λ|), for 0 < ε <= 1.
double half_extent(double lambda, double epsilon, double delta);
/// How far a circle of curvature λ is from its tangent at a distance: (1 − √(1 − (λh)²)) / |λ|.
double sagitta(double lambda, double distance);
/// Sets half_u, half_v and bound.
void set_extents(DifferentialPoint& point, double epsilon, double delta);

/// The normal field of eq. 10 (2003) at (x, y) of the tangent plane, in the point's frame and normalised: the
/// normal turned as far as it turns along the arc of the osculating circle above (x, y). Beyond the circle's
/// end it is that of the end.
Vec3 local_normal_field(double lambda_u, double lambda_v, double x, double y);
/// The same in the part's space.
Vec3 normal_field(const DifferentialPoint& point, double x, double y);

/// Samples of one parameter patch, rows along u: grid_points[first + i · columns + j] is the index of the
/// point at (i, j), or kNoPoint where there is none (outside the trims, or no curvature).
struct SampleGrid {
  std::uint32_t first = 0, rows = 0, columns = 0;
};
inline constexpr std::uint32_t kNoPoint = 0xffffffffU;

struct PartPoints {
  std::vector<DifferentialPoint> points;
  // Which points are neighbours of which: grids of samples, or the edges of a mesh; neither for points
  // without order.
  std::vector<SampleGrid> grids;
  std::vector<std::uint32_t> grid_points;
  std::vector<std::array<std::uint32_t, 2>> edges;
  bool pruned = false;  ///< grids and edges have lost points: what is left of them is not next to each other
  std::vector<SkippedFace> skipped;  ///< faces without a point
};

/// A whole model's, part by part; instances are the model's.
struct PointScene {
  std::vector<PartPoints> parts;
  double epsilon = 0, delta = 0;  ///< what the rectangles were made with; 0 for certified points
  std::vector<std::string> notes;
  std::size_t count() const;
};

/// A point as a placement shows it: exact curvatures under any affine map; half-extents by the map's mean
/// scale.
DifferentialPoint placed(const DifferentialPoint& point, const Affine3& to_world);

}  // namespace dupin

#endif
