// Shapes through points with normals: linear least squares from how their normals lie, then Gauss–Newton on
// the distances.
//
//   plane     the points' covariance                  sphere    p = c + r n
//   cylinder  normals ⟂ axis; p = c + r n across it   cone      normals at one angle to the axis; tangent
//   planes meet in the apex torus     all normals meet the axis, so (n, p × n) lies in a linear line complex
//   (Pottmann & Wallner); in the meridian
//             plane p = c + r n again
#include "shape_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dupin {
namespace {

template <int N>
using Vector = std::array<double, N>;
template <int N>
using Matrix = std::array<std::array<double, N>, N>;

/// Eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi rotations.
template <int N>
Vector<N> least_eigenvector(Matrix<N> a) {
  Matrix<N> v{};
  for (int i = 0; i < N; ++i) v[i][i] = 1;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0, diagonal = 0;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) (i == j ? diagonal : off) += a[i][j] * a[i][j];
    if (off <= 1e-32 * diagonal) break;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(1, theta));
        const double c = 1 / std::hypot(1, t), s = t * c;
        for (int k = 0; k < N; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < N; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
        }
        for (int k = 0; k < N; ++k) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
        }
      }
  }
  int least = 0;
  for (int i = 1; i < N; ++i)
    if (a[i][i] < a[least][least]) least = i;
  Vector<N> out;
  for (int k = 0; k < N; ++k) out[k] = v[k][least];
  return out;
}

/// Normal equations of a linear least-squares problem in N unknowns.
template <int N>
class LeastSquares {
 public:
  void add(const Vector<N>& row, double value) {
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) a_[i][j] += row[i] * row[j];
      b_[i] += row[i] * value;
    }
  }
  /// With `damping` times the largest diagonal entry added to all of them; empty if singular.
  std::optional<Vector<N>> solve(double damping = 0) const {
    Matrix<N> a = a_;
    Vector<N> x = b_;
    double largest = 0;
    for (int i = 0; i < N; ++i) largest = std::max(largest, a[i][i]);
    if (!(largest > 0)) return std::nullopt;
    for (int i = 0; i < N; ++i) a[i][i] += damping * largest;
    for (int i = 0; i < N; ++i) {  // Cholesky-like elimination; the matrix is positive semidefinite
      if (!(a[i][i] > 1e-14 * largest)) return std::nullopt;
      for (int k = i + 1; k < N; ++k) {
        const double f = a[k][i] / a[i][i];
        for (int j = i; j < N; ++j) a[k][j] -= f * a[i][j];
        x[k] -= f * x[i];
      }
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int j = i + 1; j < N; ++j) x[i] -= a[i][j] * x[j];
      x[i] /= a[i][i];
    }
    return x;
  }

 private:
  Matrix<N> a_{};
  Vector<N> b_{};
};

using Points = std::vector<OrientedPoint>;

Frame3 frame_about(const Vec3& origin, const Vec3& z) {
  const Vec3 x = any_perpendicular(z);
  return {origin, x, cross(z, x), z};
}

template <class Get>
Matrix<3> covariance(const Points& points, const Vec3& center, Get get) {
  Matrix<3> m{};
  for (const OrientedPoint& point : points) {
    const Vec3 d = get(point) - center;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += d[i] * d[j];
  }
  return m;
}

Vec3 to_vec(const Vector<3>& v) {
  return {v[0], v[1], v[2]};
}

template <class Get>
Vec3 mean(const Points& points, Get get) {
  Vec3 sum;
  for (const OrientedPoint& point : points) sum += get(point);
  return sum / static_cast<double>(points.size());
}
Vec3 position(const OrientedPoint& point) {
  return point.p;
}
Vec3 normal(const OrientedPoint& point) {
  return point.n;
}

std::optional<Surface> fit_plane(const Points& points) {
  const Vec3 center = mean(points, position);
  return Surface{Plane{
      frame_about(center, normalized(to_vec(least_eigenvector<3>(covariance(points, center, position)))))}};
}

std::optional<Surface> fit_sphere(const Points& points) {
  LeastSquares<4> system;
  for (const OrientedPoint& point : points)
    for (int i = 0; i < 3; ++i) {
      Vector<4> row{0, 0, 0, point.n[i]};
      row[i] = 1;
      system.add(row, point.p[i]);
    }
  const auto x = system.solve();
  if (!x || (*x)[3] == 0) return std::nullopt;
  return Surface{Sphere{frame_about({(*x)[0], (*x)[1], (*x)[2]}, {0, 0, 1}), std::abs((*x)[3])}};
}

/// A circle of points (x, y) with normals (a, b), not necessarily unit: centre and signed radius.
struct CirclePoint {
  double x, y, a, b;
};
std::optional<Vector<3>> fit_circle(const std::vector<CirclePoint>& points) {
  LeastSquares<3> system;
  for (const CirclePoint& c : points) {
    system.add({1, 0, c.a}, c.x);
    system.add({0, 1, c.b}, c.y);
  }
  return system.solve();
}

std::optional<Surface> fit_cylinder(const Points& points) {
  const Vec3 axis = normalized(to_vec(least_eigenvector<3>(covariance(points, {}, normal))));
  const Frame3 frame = frame_about({}, axis);
  std::vector<CirclePoint> circle;
  for (const OrientedPoint& point : points)
    circle.push_back(
        {dot(point.p, frame.x), dot(point.p, frame.y), dot(point.n, frame.x), dot(point.n, frame.y)});
  const auto c = fit_circle(circle);
  if (!c || (*c)[2] == 0) return std::nullopt;
  return Surface{Cylinder{frame_about(frame.to_world({(*c)[0], (*c)[1], 0}), axis), std::abs((*c)[2])}};
}

std::optional<Surface> fit_cone(const Points& points) {
  Vec3 axis = normalized(to_vec(least_eigenvector<3>(covariance(points, mean(points, normal), normal))));
  LeastSquares<3> system;
  for (const OrientedPoint& point : points)
    system.add({point.n.x, point.n.y, point.n.z}, dot(point.n, point.p));
  const auto x = system.solve();
  if (!x) return std::nullopt;
  const Vec3 apex = to_vec(*x), center = mean(points, position);
  if (dot(center - apex, axis) < 0) axis = -axis;
  double along = 0, across = 0;
  for (const OrientedPoint& point : points) {
    const Vec3 d = point.p - apex;
    along += dot(d, axis);
    across += length(cross(d, axis));
  }
  const double angle = std::atan2(across, along);
  if (!(angle > 1e-6 && angle < 1.57079)) return std::nullopt;
  return Surface{Cone{frame_about(apex, axis), 0, angle}};
}

std::optional<Surface> fit_torus(const Points& points) {
  const auto axis = fit_axis(points);
  if (!axis) return std::nullopt;
  std::vector<CirclePoint> circle;
  for (const OrientedPoint& point : points) {
    const Vec3 d = point.p - axis->origin;
    const double z = dot(d, axis->direction);
    const Vec3 across = d - axis->direction * z, radial = normalized(across);
    circle.push_back({length(across), z, dot(point.n, radial), dot(point.n, axis->direction)});
  }
  const auto c = fit_circle(circle);
  if (!c || !((*c)[0] > 0) || (*c)[2] == 0) return std::nullopt;
  return Surface{Torus{frame_about(axis->origin + axis->direction * (*c)[1], axis->direction), (*c)[0],
                       std::abs((*c)[2])}};
}

std::optional<Surface> fit_linear(ShapeKind kind, const Points& points) {
  switch (kind) {
    case ShapeKind::plane:
      return fit_plane(points);
    case ShapeKind::sphere:
      return fit_sphere(points);
    case ShapeKind::cylinder:
      return fit_cylinder(points);
    case ShapeKind::cone:
      return fit_cone(points);
    case ShapeKind::torus:
      return fit_torus(points);
  }
  return std::nullopt;
}

Frame3& frame_of(Surface& shape) {
  switch (shape.geometry.index()) {
    case 0:
      return std::get<Plane>(shape.geometry).frame;
    case 1:
      return std::get<Cylinder>(shape.geometry).frame;
    case 2:
      return std::get<Cone>(shape.geometry).frame;
    case 3:
      return std::get<Sphere>(shape.geometry).frame;
    default:
      return std::get<Torus>(shape.geometry).frame;
  }
}

/// A shape has 7 parameters here: a translation, turns about x and y, and two sizes, not all of which matter
/// to each.
constexpr int kParameters = 7;

Surface changed(const Surface& shape, const Vector<kParameters>& by) {
  Surface out = shape;
  Frame3& frame = frame_of(out);
  const Vec3 z = normalized(frame.z + frame.x * by[4] - frame.y * by[3]);
  const Vec3 x = normalized(frame.x - z * dot(frame.x, z));
  frame = {frame.origin + Vec3{by[0], by[1], by[2]}, x, cross(z, x), z};
  if (auto* cylinder = std::get_if<Cylinder>(&out.geometry)) cylinder->radius += by[5];
  if (auto* cone = std::get_if<Cone>(&out.geometry)) cone->half_angle += by[5];
  if (auto* sphere = std::get_if<Sphere>(&out.geometry)) sphere->radius += by[5];
  if (auto* torus = std::get_if<Torus>(&out.geometry)) torus->major += by[5], torus->minor += by[6];
  return out;
}

double largest_distance(const Surface& shape, const Points& points) {
  double largest = 0;
  for (const OrientedPoint& point : points)
    largest = std::max(largest, std::abs(signed_distance(shape, point.p)));
  return largest;
}

/// Gauss–Newton on the distances, whose gradients are differences: linear fits are weighted oddly, and
/// rounding of the axis shows far from it. Points of unit extent.
Surface refined(Surface shape, const Points& points) {
  double best = largest_distance(shape, points);
  for (int step = 0; step < 4; ++step) {
    constexpr double kStep = 1e-5;
    std::array<std::array<Surface, 2>, kParameters> around;
    for (int k = 0; k < kParameters; ++k)
      for (int side = 0; side < 2; ++side) {
        Vector<kParameters> by{};
        by[k] = side ? kStep : -kStep;
        around[k][side] = changed(shape, by);
      }
    LeastSquares<kParameters> system;
    for (const OrientedPoint& point : points) {
      Vector<kParameters> row;
      for (int k = 0; k < kParameters; ++k)
        row[k] =
            (signed_distance(around[k][1], point.p) - signed_distance(around[k][0], point.p)) / (2 * kStep);
      system.add(row, -signed_distance(shape, point.p));
    }
    const auto by = system.solve(1e-12);
    if (!by) break;
    const Surface next = changed(shape, *by);
    const double distance = largest_distance(next, points);
    if (!(distance < best)) break;
    shape = next;
    best = distance;
  }
  return shape;
}

/// Into the unit box about the origin, and back.
struct Normalization {
  Vec3 center;
  double extent = 1;
  explicit Normalization(const Points& points) {
    Box3 box;
    for (const OrientedPoint& point : points) box.add(point.p);
    center = box.center();
    extent = box.diagonal() > 0 ? box.diagonal() : 1;
  }
  Points apply(const Points& points) const {
    Points out = points;
    for (OrientedPoint& point : out) point.p = (point.p - center) / extent;
    return out;
  }
  Surface undo(Surface shape) const {
    Frame3& frame = frame_of(shape);
    frame.origin = frame.origin * extent + center;
    if (auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) cylinder->radius *= extent;
    if (auto* sphere = std::get_if<Sphere>(&shape.geometry)) sphere->radius *= extent;
    if (auto* torus = std::get_if<Torus>(&shape.geometry)) torus->major *= extent, torus->minor *= extent;
    return shape;
  }
};

}  // namespace

std::optional<Surface> fit_shape(ShapeKind kind, const std::vector<OrientedPoint>& points) {
  if (points.size() < 6) return std::nullopt;
  const Normalization normalization(points);
  const Points unit = normalization.apply(points);
  const auto shape = fit_linear(kind, unit);
  if (!shape || !(largest_distance(*shape, unit) < 1e-2)) return std::nullopt;
  return normalization.undo(refined(*shape, unit));
}

double signed_distance(const Surface& shape, const Vec3& p) {
  if (const auto* plane = std::get_if<Plane>(&shape.geometry))
    return dot(plane->frame.z, p - plane->frame.origin);
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
    return distance(p, sphere->frame.origin) - sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) {
    const Vec3 q = cylinder->frame.to_local(p);
    return std::hypot(q.x, q.y) - cylinder->radius;
  }
  if (const auto* cone = std::get_if<Cone>(&shape.geometry)) {
    const Vec3 q = cone->frame.to_local(p);
    return (std::hypot(q.x, q.y) - cone->radius) * std::cos(cone->half_angle) -
           q.z * std::sin(cone->half_angle);
  }
  const auto& torus = std::get<Torus>(shape.geometry);
  const Vec3 q = torus.frame.to_local(p);
  return std::hypot(std::hypot(q.x, q.y) - torus.major, q.z) - torus.minor;
}

// The normal's line through p with direction n meets the axis through q with direction a if n·(q × a) + (p ×
// n)·a = 0.
std::optional<Axis> fit_axis(const std::vector<OrientedPoint>& points) {
  Matrix<6> m{};
  for (const OrientedPoint& point : points) {
    const Vec3 moment = cross(point.p, point.n);
    const Vector<6> line{moment.x, moment.y, moment.z, point.n.x, point.n.y, point.n.z};
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) m[i][j] += line[i] * line[j];
  }
  const Vector<6> complex = least_eigenvector<6>(m);
  const Vec3 a{complex[0], complex[1], complex[2]}, b{complex[3], complex[4], complex[5]};
  const double square = dot(a, a);
  if (!(square > 1e-8)) return std::nullopt;
  // A complex with pitch belongs to a helical surface.
  if (std::abs(dot(a, b)) > 1e-4 * square) return std::nullopt;
  return Axis{cross(a, b) / square, a / std::sqrt(square)};
}

}  // namespace dupin
