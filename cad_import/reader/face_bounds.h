// Boxes of curves and faces in space.
#ifndef DUPIN_CAD_IMPORT_READER_FACE_BOUNDS_H
#define DUPIN_CAD_IMPORT_READER_FACE_BOUNDS_H

#include "../../nurbs/model.h"

namespace dupin::reader {

/// Contains the curve over [t0, t1], to within rounding.
Box3 curve_bounds(const Curve3& curve, double t0, double t1);

/// Contains the surface over `uv`; tight for the analytic kinds.
Box3 surface_bounds(const Surface& surface, const Box2& uv);

/// Contains the face, and little else. `edge_boxes` has each edge's, empty for degenerate ones.
Box3 face_bounds(const Part& part, const Face& face, const std::vector<Box3>& edge_boxes);

}  // namespace dupin::reader

#endif
