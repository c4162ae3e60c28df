// Inside the folder: least squares of three unknowns.
#ifndef DUPIN_SAMPLING_SMALL_SOLVE_H
#define DUPIN_SAMPLING_SMALL_SOLVE_H

#include <cmath>

#include "../core/vec.h"

namespace dupin {

/// The first `unknowns` of the normal equations g x = r, the others 0, with a ridge relative to each one's
/// own size.
inline Vec3 solve_ridge(const double g[3][3], const double r[3], int unknowns) {
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, y[3] = {}, scale[3] = {};
  for (int k = 0; k < unknowns; ++k) scale[k] = g[k][k] > 0 ? 1 / std::sqrt(g[k][k]) : 0;
  for (int k = 0; k < unknowns; ++k) {
    y[k] = r[k] * scale[k];
    for (int l = 0; l < unknowns; ++l) m[k][l] = g[k][l] * scale[k] * scale[l] + (k == l ? 1e-10 : 0);
  }
  const Vec3 x =
      inverse(Mat3{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}) *
      Vec3{y[0], y[1], y[2]};
  return {x.x * scale[0], x.y * scale[1], x.z * scale[2]};
}

}  // namespace dupin

#endif
