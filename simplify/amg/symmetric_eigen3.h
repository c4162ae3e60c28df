// Eigenvalues and vectors of symmetric 3×3 matrices, by Jacobi's rotations: small eigenvalues keep their
// relative accuracy, which closed formulas lose on flat neighborhoods.
#ifndef DUPIN_SIMPLIFY_AMG_SYMMETRIC_EIGEN3_H
#define DUPIN_SIMPLIFY_AMG_SYMMETRIC_EIGEN3_H

#include <array>

#include "../../core/vec.h"

namespace dupin::amg {

/// xx, xy, xz, yy, yz, zz
using Symmetric3 = std::array<double, 6>;

struct Eigen3 {
  std::array<double, 3> values{};  ///< largest first
  std::array<Vec3, 3> vectors;     ///< unit, right-handed
};

Eigen3 eigen(const Symmetric3& m);

}  // namespace dupin::amg

#endif
