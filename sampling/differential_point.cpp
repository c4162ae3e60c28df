#include "differential_point.h"

namespace dupin {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;

/// arcsin(x)/x, and 1 at 0; for |x| >= 1 the arc ends.
double arcsine_ratio(double x) {
  const double a = std::abs(x);
  if (a < 1e-4) return 1 + a * a / 6;
  return (a < 1 ? std::asin(a) : kHalfPi) / a;
}

}  // namespace

double half_extent(double lambda, double epsilon, double delta) {
  const double reach = std::sqrt(2 * epsilon - epsilon * epsilon);
  return reach < delta * std::abs(lambda) ? reach / std::abs(lambda) : delta;
}

double sagitta(double lambda, double h) {
  const double s = std::min(1.0, lambda * lambda * h * h);
  return std::abs(lambda) * h * h / (1 + std::sqrt(1 - s));
}

void set_extents(DifferentialPoint& point, double epsilon, double delta) {
  point.half_u = half_extent(point.lambda_u, epsilon, delta);
  point.half_v = half_extent(point.lambda_v, epsilon, delta);
  point.bound = std::max(sagitta(point.lambda_u, point.half_u), sagitta(point.lambda_v, point.half_v));
}

Vec3 local_normal_field(double lambda_u, double lambda_v, double x, double y) {
  // Eq. 10 divides by λ(t)·√(x² + y²) = sine of the arc's angle; arcsine over sine stays finite where that is
  // 0.
  const double r2 = x * x + y * y;
  const double bend = lambda_u * x * x + lambda_v * y * y;
  const double sine = r2 > 0 ? bend / std::sqrt(r2) : 0;
  const double stretch = arcsine_ratio(sine);
  return normalized({-lambda_u * x * stretch, -lambda_v * y * stretch, 1});
}

Vec3 normal_field(const DifferentialPoint& point, double x, double y) {
  const Vec3 n = local_normal_field(point.lambda_u, point.lambda_v, x, y);
  return point.u * n.x + point.v * n.y + point.n() * n.z;
}

std::size_t PointScene::count() const {
  std::size_t n = 0;
  for (const PartPoints& part : parts) n += part.points.size();
  return n;
}

DifferentialPoint placed(const DifferentialPoint& point, const Affine3& to_world) {
  DifferentialPoint result = point;
  const Mat3& m = to_world.linear;
  result.position = transform_point(to_world, point.position);
  const bool mirrored = determinant(m) < 0;
  // The surface x û + y v̂ + ½(λu x² + λv y²) n, mapped; a mirror turns Su × Sv inwards, so that v is turned
  // too.
  SurfaceJet jet;
  const Vec3 bend = m * point.n();
  jet.pu = m * point.u;
  jet.pv = m * (mirrored ? -point.v : point.v);
  jet.puu = bend * point.lambda_u;
  jet.pvv = bend * point.lambda_v;
  const Curvature curvature = principal_curvature(jet);
  const double scale = std::cbrt(std::abs(determinant(m)));
  const bool swapped = std::abs(dot(curvature.d1, jet.pu)) * length(jet.pv) <
                       std::abs(dot(curvature.d1, jet.pv)) * length(jet.pu);
  result.u = curvature.d1;
  result.v = curvature.d2;
  result.lambda_u = curvature.k1;
  result.lambda_v = curvature.k2;
  result.half_u = scale * (swapped ? point.half_v : point.half_u);
  result.half_v = scale * (swapped ? point.half_u : point.half_v);
  result.bound = scale * point.bound;
  return result;
}

}  // namespace dupin
