// Rectangles that a planar DP with boundary pieces is drawn by: those inside its region need no test, those
// along its boundary are tested against the few pieces that reach into them, and what lies outside is not
// touched at all.
#ifndef DUPIN_RENDER_PLANAR_COVER_H
#define DUPIN_RENDER_PLANAR_COVER_H

#include <vector>

#include "../sampling/quadric_dp.h"

namespace dupin {

/// A rectangle with the part of the region's description that matters in it; ellipses have become arcs.
struct BoundaryRectangle {
  Box2 box;
  Vec2 reference;                 ///< in the box, not near any of the pieces
  bool reference_inside = false;  ///< as QuadricDp's, for these pieces
  std::vector<LinePiece> lines;
  std::vector<ArcPiece> arcs;
};

/// Axis-parallel in the DP's (x, y), disjoint; together they cover the region. All points of `inside` are
/// drawn, and those that are kCoverMargin cells away.
struct PlanarCover {
  std::vector<Box2> inside;
  std::vector<BoundaryRectangle> boundary;
};

/// Of the size of a cell: how near the boundary may come to an inside rectangle.
inline constexpr double kCoverMargin = 0.1;

/// For a planar DP without clip planes, from resolution × resolution cells of the footprint's box.
PlanarCover planar_cover(const PartDps& part, const QuadricDp& dp, int resolution);

/// The rectangle's own test, in double; what the shader does with it.
bool boundary_contains(const BoundaryRectangle& rectangle, Vec2 p);

}  // namespace dupin

#endif
