// Small fixed-size vectors, matrices, boxes and affine maps in double precision.
//
// Everything in the library above the GPU is computed in double; this header holds just what that needs, in
// the plainest form: aggregates with free functions. Matrices are stored by columns.
#ifndef DUPIN_CORE_VEC_H
#define DUPIN_CORE_VEC_H

#include <algorithm>
#include <cmath>
#include <limits>

namespace dupin {

struct Vec2 {
  double x = 0, y = 0;
  double& operator[](int i) { return i == 0 ? x : y; }
  double operator[](int i) const { return i == 0 ? x : y; }
  friend bool operator==(const Vec2&, const Vec2&) = default;
};
inline Vec2 operator+(Vec2 a, Vec2 b) {
  return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator-(Vec2 a) {
  return {-a.x, -a.y};
}
inline Vec2 operator*(Vec2 a, double s) {
  return {a.x * s, a.y * s};
}
inline Vec2 operator*(double s, Vec2 a) {
  return a * s;
}
inline Vec2 operator/(Vec2 a, double s) {
  return {a.x / s, a.y / s};
}
inline Vec2& operator+=(Vec2& a, Vec2 b) {
  return a = a + b;
}
inline double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
/// The z component of the cross product: twice the signed area of the triangle (0, a, b).
inline double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
inline double length(Vec2 a) {
  return std::sqrt(dot(a, a));
}

struct Vec3 {
  double x = 0, y = 0, z = 0;
  double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};
inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(const Vec3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return a * s;
}
inline Vec3 operator/(const Vec3& a, double s) {
  return {a.x / s, a.y / s, a.z / s};
}
inline Vec3& operator+=(Vec3& a, const Vec3& b) {
  return a = a + b;
}
inline Vec3& operator-=(Vec3& a, const Vec3& b) {
  return a = a - b;
}
inline Vec3& operator*=(Vec3& a, double s) {
  return a = a * s;
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline double distance(const Vec3& a, const Vec3& b) {
  return length(a - b);
}
/// a / |a|; the zero vector for the zero vector.
inline Vec3 normalized(const Vec3& a) {
  const double l = length(a);
  return l > 0 ? a / l : Vec3{};
}
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// A unit vector perpendicular to the unit vector n, chosen the same way every time.
inline Vec3 any_perpendicular(const Vec3& n) {
  const Vec3 axis = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                    : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                     : Vec3{0, 0, 1};
  return normalized(cross(n, axis));
}

/// A 3x3 matrix by columns.
struct Mat3 {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  friend bool operator==(const Mat3&, const Mat3&) = default;
};
inline Vec3 operator*(const Mat3& m, const Vec3& v) {
  return m.x * v.x + m.y * v.y + m.z * v.z;
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  return {a * b.x, a * b.y, a * b.z};
}
inline Vec3 transpose_times(const Mat3& m, const Vec3& v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
inline double determinant(const Mat3& m) {
  return dot(m.x, cross(m.y, m.z));
}
/// The inverse transposed, times the determinant: takes normals along with points.
inline Mat3 cofactor(const Mat3& m) {
  return {cross(m.y, m.z), cross(m.z, m.x), cross(m.x, m.y)};
}
inline Mat3 transpose(const Mat3& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
inline Mat3 inverse(const Mat3& m) {
  const Mat3 c = cofactor(m);
  const double d = 1 / determinant(m);
  return transpose({c.x * d, c.y * d, c.z * d});
}

/// x ↦ linear * x + translation.
struct Affine3 {
  Mat3 linear;
  Vec3 translation;
  friend bool operator==(const Affine3&, const Affine3&) = default;
};
inline Vec3 transform_point(const Affine3& t, const Vec3& p) {
  return t.linear * p + t.translation;
}
inline Vec3 transform_vector(const Affine3& t, const Vec3& v) {
  return t.linear * v;
}
/// First b, then a.
inline Affine3 operator*(const Affine3& a, const Affine3& b) {
  return {a.linear * b.linear, transform_point(a, b.translation)};
}
inline Affine3 inverse(const Affine3& t) {
  const Mat3 i = inverse(t.linear);
  return {i, -(i * t.translation)};
}

/// A right-handed or left-handed orthonormal frame; x, y, z are unit length and perpendicular.
struct Frame3 {
  Vec3 origin;
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3 to_world(const Vec3& p) const { return origin + x * p.x + y * p.y + z * p.z; }
  Vec3 to_local(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {dot(d, x), dot(d, y), dot(d, z)};
  }
  friend bool operator==(const Frame3&, const Frame3&) = default;
};

struct Box2 {
  Vec2 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y); }
  void add(Vec2 p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  Vec2 center() const { return (lo + hi) * 0.5; }
  Vec2 size() const { return hi - lo; }
  bool contains(Vec2 p) const { return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y; }
};
inline bool overlap(const Box2& a, const Box2& b) {
  return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y;
}

struct Box3 {
  Vec3 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::infinity()};
  Vec3 hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()};
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  void add(const Vec3& p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  void add(const Box3& b) {
    if (!b.empty()) add(b.lo), add(b.hi);
  }
  Vec3 center() const { return (lo + hi) * 0.5; }
  Vec3 size() const { return hi - lo; }
  /// Length of the diagonal; 0 for an empty box.
  double diagonal() const { return empty() ? 0 : length(hi - lo); }
  Vec3 corner(int i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; }
  bool contains(const Vec3& p) const {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
  }
};
/// The box of the images of b's corners.
inline Box3 transform_box(const Affine3& t, const Box3& b) {
  Box3 r;
  if (!b.empty())
    for (int i = 0; i < 8; ++i) r.add(transform_point(t, b.corner(i)));
  return r;
}

}  // namespace dupin

#endif
