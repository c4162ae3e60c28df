// The quadric differential point: a neighbourhood of a surface, drawn exactly.
//
// In the principal frame at a point, with x along û, y along v̂ and z along n = û × v̂, every quadric through
// the point with that tangent plane and those principal curvatures is the zero set of
//
//     F(x,y,z) = z − ½(λu x² + λv y²) − a·xz − b·yz − ½ c·z²                (docs/mathematics.md, "Quadric
//     DPs")
//
// so a plane, cylinder, cone or sphere is its own DP, however large. What is drawn of it is bounded by a
// region:
//
//   1. the *footprint*, a convex quadrilateral in (x,y), and z_lo <= z <= z_hi;
//   2. *planes* (AND): n·p + d >= 0 in the DP's frame, for what no footprint can say (a whole cone's ends);
//   3. *boundary pieces* (parity): lines, conic arcs and whole ellipses in (x,y). A point of the footprint is
//   inside if the
//      parity of `reference_inside`, plus the number of chords (lines, and arcs' p0p2) that the segment from
//      `reference` to it crosses, plus the number of arcs' bulges and ellipses that it lies in, is odd (true
//      counts as 1).
//
// A conic arc is a rational quadratic Bézier (p0, p1, p2; weights 1, w, 1) and stands for its chord p0p2 plus
// its bulge, the area between chord and arc. Shared end points are the same numbers, so a chain of pieces has
// no cracks whatever the rounding. `reference_inside` therefore has the bulges and ellipses that hold the
// reference itself folded in. Pieces need only be complete within the footprint (the segment never leaves it,
// being convex and holding the reference); what lies beyond it may be cut off anywhere. No pieces: the whole
// footprint, if `reference_inside`.
#ifndef DUPIN_SAMPLING_QUADRIC_DP_H
#define DUPIN_SAMPLING_QUADRIC_DP_H

#include <array>
#include <cstdint>
#include <vector>

#include "../core/vec.h"
#include "../nurbs/model.h"

namespace dupin {

/// n·p + d >= 0 inside.
struct ClipPlane {
  Vec3 n;
  double d = 0;
  bool feature = false;
};
struct LinePiece {
  Vec2 p0, p1;
  bool feature = false;  ///< part of an edge that is drawn as a line
};
/// Less than a half turn: p1 is finite, and the arc lies in the triangle p0 p1 p2. w > 0.
struct ArcPiece {
  Vec2 p0, p1, p2;
  double w = 1;
  bool feature = false;
};
/// Inside of |m (p − center)|² <= 1, m symmetric: mxx, mxy, myy.
struct EllipsePiece {
  Vec2 center;
  double mxx = 1, mxy = 0, myy = 1;
  bool feature = false;
};

/// Of a normal's correction; what its storage has room for.
inline constexpr double kMostTilt = 0.25;

struct QuadricDp {
  Vec3 origin;                  ///< in the part's space
  Vec3 u{1, 0, 0}, v{0, 1, 0};  ///< unit, perpendicular
  double lambda_u = 0, lambda_v = 0;
  double a = 0, b = 0, c = 0;
  /// Terms of the shading normal alone: the surface drawn is F = 0, the normal drawn there is ∇F − ∇C with
  /// C = t0·x + t1·y + c0·x³ + c1·x²y + c2·xy² + c3·y³. All 0 where the quadric's own normal is close enough.
  std::array<double, 4> cubic{0, 0, 0, 0};
  std::array<double, 2> tilt{0, 0};  ///< |t| <= kMostTilt
  std::array<Vec2, 4> footprint;     ///< convex, counter-clockwise; a corner may be repeated
  double z_lo = 0, z_hi = 0;
  /// Bits 0–3: footprint side i (from corner i to i+1) is a feature edge; bit 4: z_lo, bit 5: z_hi.
  std::uint8_t feature_sides = 0;
  bool planar = false;     ///< F is z: the proxy is the surface
  bool flipped = false;    ///< the face's outward normal is −∇F (n points inward)
  bool exact = false;      ///< the face's surface itself, not an approximation: bounds are rounding alone
  std::uint32_t face = 0;  ///< index in the part
  // The region's pieces, consecutive in the part's arrays.
  std::uint32_t first_plane = 0, first_line = 0, first_arc = 0, first_ellipse = 0;
  std::uint16_t planes = 0, lines = 0, arcs = 0, ellipses = 0;
  Vec2 reference;
  bool reference_inside = true;
  /// Certified: no point drawn is farther than `bound` (model units) from the face's surface, and no drawn
  /// normal turned by more than `normal_bound` (radians) from the surface's there. docs/mathematics.md,
  /// "Certificates". Where the file's own edge lies off the surface the face reaches outwards for it, at most
  /// eight times the edge's tolerance: that is not counted in `bound`, nor in `normal_bound` what lies beyond
  /// the face's edges.
  double bound = 0, normal_bound = 0;
  bool sampled_bound =
      false;  ///< on an offset surface the bounds hold a sampled part: estimated, not certified
  bool speck =
      false;  ///< smaller than the tolerance, at a singular point: flat, and `normal_bound` says nothing
  Box2 cell;  ///< the parameter rectangle it was made for; where u, v of a pixel are searched from
  Vec3 n() const { return cross(u, v); }
};

/// F and its gradient at a point of the DP's frame.
inline double quadric_value(const QuadricDp& d, const Vec3& p) {
  return p.z - 0.5 * (d.lambda_u * p.x * p.x + d.lambda_v * p.y * p.y) - d.a * p.x * p.z - d.b * p.y * p.z -
         0.5 * d.c * p.z * p.z;
}
inline Vec3 quadric_gradient(const QuadricDp& d, const Vec3& p) {
  return {-d.lambda_u * p.x - d.a * p.z, -d.lambda_v * p.y - d.b * p.z,
          1 - d.a * p.x - d.b * p.y - d.c * p.z};
}

/// The normal drawn at a point of the DP's frame, towards the side of n; not normalised.
inline Vec3 drawn_normal(const QuadricDp& d, const Vec3& p) {
  const auto& c = d.cubic;
  return quadric_gradient(d, p) -
         Vec3{d.tilt[0] + 3 * c[0] * p.x * p.x + 2 * c[1] * p.x * p.y + c[2] * p.y * p.y,
              d.tilt[1] + c[1] * p.x * p.x + 2 * c[2] * p.x * p.y + 3 * c[3] * p.y * p.y, 0};
}

/// One part's DPs and the pieces that bound them.
struct PartDps {
  std::vector<QuadricDp> dps;
  std::vector<ClipPlane> planes;
  std::vector<LinePiece> lines;
  std::vector<ArcPiece> arcs;
  std::vector<EllipsePiece> ellipses;
  std::vector<SkippedFace> skipped;  ///< faces that could not be made into DPs
  /// Faces without a DP because nothing of them is in the camera's picture: drawn, with nothing to see.
  std::vector<std::uint32_t> out_of_picture;
  double bound_px = 0;  ///< see DpScene
};

/// Appends another part's (or face's) DPs and pieces.
void append(const PartDps& from, PartDps& to);
void append(PartDps&& from, PartDps& to);

/// Whether a point p of the DP's frame, on F = 0, is drawn: the region's three tests, as the shader makes
/// them.
bool region_contains(const PartDps& part, const QuadricDp& dp, const Vec3& p);
/// Only the third test: whether (x,y), a point of the footprint, is on the inner side of the boundary pieces.
bool pieces_contain(const PartDps& part, const QuadricDp& dp, Vec2 p);

/// A whole model's, part by part; instances are the model's.
struct DpScene {
  std::vector<PartDps> parts;
  double bound = 0, normal_bound = 0;  ///< the largest of all DPs (specks left out of normal_bound; radians)
  double bound_px = 0;  ///< the largest bound in pixels where its DP is nearest to the camera; 0 without one
  std::size_t count() const;
};

}  // namespace dupin

#endif
