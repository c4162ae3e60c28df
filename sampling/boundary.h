// Where faces end: every edge of a part as one chain of conic arcs, shared by the faces that meet in it.
#ifndef DUPIN_SAMPLING_BOUNDARY_H
#define DUPIN_SAMPLING_BOUNDARY_H

#include <vector>

#include "../nurbs/model.h"
#include "conic_arc.h"
#include "part_edges.h"

namespace dupin {

struct FaceArc {
  ConicArc3 arc;
  bool feature = false;  ///< drawn as an edge line
  Box2 uv;               ///< contains the pcurve over the arc
  double reach = 0;      ///< how far it was moved outwards, over the edge
  double bound = 0;  ///< how far it may be from the face's own edge; not counted is what the file's is off
};
/// A loop that is one whole circle or ellipse: center + cos t·x + sin t·y.
struct WholeEllipse {
  Vec3 center, x, y;
  bool feature = false;
  double bound = 0;  ///< as of an arc
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
  double reach = 0;                         ///< the largest of its arcs
};

/// `with_uv`: flatten the pcurves too (uv_loops, FaceArc::uv).
FaceBoundary face_boundary(const Part& part, std::uint32_t face, const PartEdges& edges, bool with_uv);

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
  double side_reach[4] = {0, 0, 0, 0};  ///< how far the face reaches over that side, a length
  double bound = 0;                     ///< the largest of it that is not due to the file's edges being off
};
UvRectangle uv_rectangle(const Part& part, std::uint32_t face, const PartEdges& edges,
                         const FaceBoundary& boundary);

}  // namespace dupin

#endif
