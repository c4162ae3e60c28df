// Where faces end: every edge of a part as one chain of conic arcs, shared by the faces that meet in it.
#ifndef DUPIN_SAMPLING_BOUNDARY_H
#define DUPIN_SAMPLING_BOUNDARY_H

#include <vector>

#include "../nurbs/model.h"
#include "conic_arc.h"

namespace dupin {

/// The chains of a part's edges, by edge. Ends that meet in a vertex are the same point, bit for bit: the
/// vertex's.
std::vector<ArcChain> part_edge_chains(const Part& part, const LocalTolerance& tolerance);

struct FaceArc {
  ConicArc3 arc;
  bool feature = false;  ///< drawn as an edge line
  Box2 uv;               ///< contains the pcurve over the arc
};
/// A loop that is one whole circle or ellipse: center + cos t·x + sin t·y.
struct WholeEllipse {
  Vec3 center, x, y;
  bool feature = false;
};
struct FaceLoop {
  std::vector<FaceArc>
      arcs;  ///< in the loop's order and direction, closed; seams and degenerate trims left out
  bool whole_ellipse = false;
  WholeEllipse ellipse;
};

struct FaceBoundary {
  std::vector<FaceLoop> loops;              ///< those with arcs
  std::vector<std::vector<Vec2>> uv_loops;  ///< closed polygons of the pcurves; only when asked for
  Box2 uv_box;                              ///< of the pcurves, or the face's own where it has no loops
};

/// `with_uv`: flatten the pcurves too (uv_loops, FaceArc::uv).
FaceBoundary face_boundary(const Part& part, const Face& face, const std::vector<ArcChain>& chains,
                           bool with_uv);

/// A trim whose edge bounds the face twice: the surface goes on across it. (A closed surface's seam may also
/// bound a face on one side only: then it is an edge like any other.)
bool is_inner_seam(const Face& face, const Trim& trim);

/// Even–odd test of a parameter point against the flattened loops; with no loops, against the box.
bool uv_inside(const FaceBoundary& boundary, Vec2 uv);

/// Whether every trim runs along a side of `uv_box` (seams included): the face is a rectangle in parameters.
/// `side_feature[i]`: some real edge lies on u = lo, u = hi, v = lo, v = hi; `side_drawn[i]`: a feature line
/// runs there.
struct UvRectangle {
  bool rectangle = false;
  bool side_drawn[4] = {false, false, false, false};
  bool side_edge[4] = {false, false, false, false};
};
UvRectangle uv_rectangle(const Part& part, const Face& face, const FaceBoundary& boundary);

}  // namespace dupin

#endif
