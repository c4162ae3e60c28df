// The classifier as a diffusion coefficient: the matrix of −div(C grad) on the points (Reniers & Telea,
// §2.2).
#ifndef DUPIN_SIMPLIFY_AMG_STIFFNESS_H
#define DUPIN_SIMPLIFY_AMG_STIFFNESS_H

#include "neighborhoods.h"
#include "sparse.h"

namespace dupin::amg {

/// How strongly two points, or two domains, hold together.
struct Coupling {
  double weight = 0;  ///< −A_ij
  double flat = 0;    ///< what it would be if C were 1 everywhere
  Coupling& operator+=(const Coupling& o) {
    weight += o.weight;
    flat += o.flat;
    return *this;
  }
};
inline Coupling operator*(const Coupling& c, double s) {
  return {c.weight * s, c.flat * s};
}
inline Coupling operator*(double s, const Coupling& c) {
  return c * s;
}

/// −A_ij for i ≠ j: on a mesh from the finite elements of its triangles (eq. 4); on loose points from those
/// of their fans in space (eq. 5), made symmetric (eq. 6). Points with nothing to be coupled to have empty
/// rows. Rows are ordered by column.
Sparse<Coupling> couplings(const UniquePoints& points, const Neighborhoods& around);

/// A itself: the diagonal, first in each row, makes every row sum to 0 (eq. 7).
Sparse<double> stiffness(const Sparse<Coupling>& couplings);

}  // namespace dupin::amg

#endif
