// Inside the folder: arithmetic of homogeneous poles, and de Casteljau.
#ifndef DUPIN_NURBS_HOMOGENEOUS_H
#define DUPIN_NURBS_HOMOGENEOUS_H

#include "bezier.h"

namespace dupin::homogeneous {

inline Vec4 sum(const Vec4& a, const Vec4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
inline Vec4 scaled(const Vec4& a, double s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}
inline Vec4 mixed(const Vec4& a, const Vec4& b, double t) {
  const double r = 1 - t;
  return {r * a.x + t * b.x, r * a.y + t * b.y, r * a.z + t * b.z, r * a.w + t * b.w};
}
inline Vec4 lifted(const Vec3& p, double w) {
  return {p.x * w, p.y * w, p.z * w, w};
}
inline Vec3 xyz(const Vec4& a) {
  return {a.x, a.y, a.z};
}
inline Vec3 projected(const Vec4& a) {
  return xyz(a) / a.w;
}

/// In place: the poles, `stride` apart, of the piece [0, t].
inline void keep_left(Vec4* poles, int degree, std::size_t stride, double t) {
  for (int level = 1; level <= degree; ++level)
    for (int i = degree; i >= level; --i)
      poles[i * stride] = mixed(poles[(i - 1) * stride], poles[i * stride], t);
}
/// In place: the poles of the piece [t, 1].
inline void keep_right(Vec4* poles, int degree, std::size_t stride, double t) {
  for (int level = degree; level >= 1; --level)
    for (int i = 0; i < level; ++i) poles[i * stride] = mixed(poles[i * stride], poles[(i + 1) * stride], t);
}
/// In place: the poles of the piece [t0, t1]; both steps are convex combinations, whichever comes first.
inline void keep_piece(Vec4* poles, int degree, std::size_t stride, double t0, double t1) {
  if (t1 >= 1 - t0) {
    if (t1 < 1) keep_left(poles, degree, stride, t1);
    if (t0 > 0) keep_right(poles, degree, stride, t0 / t1);
  } else {
    if (t0 > 0) keep_right(poles, degree, stride, t0);
    keep_left(poles, degree, stride, (t1 - t0) / (1 - t0));
  }
}

}  // namespace dupin::homogeneous

#endif
