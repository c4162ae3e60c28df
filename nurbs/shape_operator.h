// Inside the folder: the shape operator in an orthonormal tangent frame, and its eigenvalues and directions.
#ifndef DUPIN_NURBS_SHAPE_OPERATOR_H
#define DUPIN_NURBS_SHAPE_OPERATOR_H

#include "surface.h"

namespace dupin {

/// In the tangent frame (e1, e2): the symmetric matrix (w11, w12; w12, w22), and how much of it is rounding.
struct ShapeOperator {
  Vec3 n, e1, e2;
  double w11 = 0, w12 = 0, w22 = 0;
  double noise = 0;
};

Curvature diagonalize(const ShapeOperator& shape);
/// Not finite, with that kind.
Curvature undefined_curvature();
/// The best projection of the x, y, z axes onto the tangent plane (the papers' rule for umbilics).
Vec3 projected_axis(const Vec3& n);

}  // namespace dupin

#endif
