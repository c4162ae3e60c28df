// Conic arcs in space: what every edge is made of before it becomes the boundary of a region.
#ifndef DUPIN_SAMPLING_CONIC_ARC_H
#define DUPIN_SAMPLING_CONIC_ARC_H

#include <functional>
#include <vector>

#include "../core/vec.h"
#include "../nurbs/model.h"

namespace dupin {

/// The rational quadratic Bézier curve with poles p0, p1, p2 and weights 1, w, 1: a line segment (`line`, p1
/// unused) or less than a half turn of a conic. It stands for the edge's curve over [t0, t1].
struct ConicArc3 {
  Vec3 p0, p1, p2;
  double w = 1;
  bool line = false;
  double t0 = 0, t1 = 0;
  double deviation = 0;  ///< largest distance from the curve; 0 where exact, and where the tolerance was
                         ///< infinite (not in any picture)
};

/// A point of the arc at its own parameter s in [0,1].
Vec3 point_at(const ConicArc3& arc, double s);
/// The part over [s0, s1], with weights brought to 1, w, 1 again.
ConicArc3 sub_arc(const ConicArc3& arc, double s0, double s1);
/// Contains the arc.
Box3 bounding_box(const ConicArc3& arc);

/// The part of the arc with n·p + d >= 0: at most two pieces, appended to `out`.
void clip_to_half_space(const ConicArc3& arc, const Vec3& n, double d, std::vector<ConicArc3>& out);

/// The tolerance that holds for a piece of curve inside a box; infinite where nothing sees it.
using LocalTolerance = std::function<double(const Box3&)>;

/// The edge as a chain of arcs from t0 to t1: exact for lines, conics and splines of degree 1 and 2, within
/// `tolerance` elsewhere. For Bézier segments the deviation is bounded by the coefficients of the difference;
/// offset curves and hyperbolas of more than one piece are checked at sample points. Empty for a degenerate
/// edge.
struct ArcChain {
  std::vector<ConicArc3> arcs;
  double deviation = 0;  ///< the largest of its arcs
};
ArcChain approximate_edge(const Edge& edge, const LocalTolerance& tolerance);

}  // namespace dupin

#endif
