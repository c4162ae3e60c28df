// Principal curvatures by the symmetric shape operator in an orthonormal tangent frame: a 2x2 symmetric eigenproblem, which keeps its
// digits where H ± sqrt(H² − K) loses half of them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "surface.h"

namespace dupin {
namespace {

/// Curvatures that differ by less than this part of the larger are one: the direction between them is rounding.
constexpr double kUmbilic = 1e-10;
/// |Su × Sv| below this part of |Su||Sv|, or a partial below this part of the other, counts as vanishing.
constexpr double kSingular = 1e-10;

/// The best projection of the x, y, z axes onto the tangent plane (the papers' rule for umbilics).
Vec3 axis_direction(const Vec3& n) {
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  int best = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(n[i]) < std::abs(n[best]) - 1e-12) best = i;
  return normalized(axes[best] - n * n[best]);
}

Curvature undefined() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {{nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan, nan, Curvature::Kind::undefined};
}

bool is_regular(const SurfaceJet& jet) {
  const double u = length(jet.pu), v = length(jet.pv);
  return std::min(u, v) > kSingular * std::max(u, v) && length(cross(jet.pu, jet.pv)) > kSingular * u * v;
}

}  // namespace

Curvature principal_curvature(const SurfaceJet& jet) {
  const double a = length(jet.pu);
  const Vec3 normal = cross(jet.pu, jet.pv);
  if (!(a > 0) || !(length(normal) > 0) || !is_finite(normal)) return undefined();
  Curvature k;
  k.n = normalized(normal);
  const Vec3 e1 = jet.pu / a, e2 = cross(k.n, e1);
  const double b = dot(jet.pv, e1), d = dot(jet.pv, e2);
  const double l = dot(jet.puu, k.n), m = dot(jet.puv, k.n), n = dot(jet.pvv, k.n);
  // A = J⁻ᵀ II J⁻¹ with J = [a b; 0 d].
  const double ba = b / a, m2 = m - l * ba, n2 = n - ba * (2 * m - l * ba);
  const double a11 = l / (a * a), a12 = m2 / (a * d), a22 = n2 / (d * d);
  const double mean = (a11 + a22) / 2, diff = (a11 - a22) / 2, r = std::hypot(diff, a12);
  if (r <= kUmbilic * std::abs(mean) || r == 0) {
    k.kind = Curvature::Kind::umbilic;
    k.d1 = axis_direction(k.n), k.d2 = cross(k.n, k.d1);
    k.k1 = k.k2 = mean;
    return k;
  }
  // Eigenvector of mean + sign·r without cancellation.
  const double sign = mean >= 0 ? 1 : -1;
  double x, y;
  if (sign * diff >= 0) x = sign * r + diff, y = a12;
  else x = a12, y = sign * r - diff;
  k.d1 = normalized(e1 * x + e2 * y), k.d2 = cross(k.n, k.d1);
  k.k1 = mean + sign * r;
  const double determinant = a11 * a22 - a12 * a12;
  k.k2 = std::abs(mean) > 0.5 * r ? determinant / k.k1 : mean - sign * r;
  return k;
}

Curvature principal_curvature(const Surface& surface, double u, double v, Vec2 inside) {
  const SurfaceJet jet = evaluate(surface, u, v, 2);
  if (is_regular(jet)) return principal_curvature(jet);
  // The limit along the way to `inside`: the value a little way in, extrapolated from two distances.
  const Vec2 way = inside - Vec2{u, v};
  if (length(way) == 0) return undefined();
  Curvature k = principal_curvature(evaluate(surface, u + 1e-5 * way.x, v + 1e-5 * way.y, 2));
  if (k.kind != Curvature::Kind::undefined) k.kind = Curvature::Kind::singular_limit;
  return k;
}

}  // namespace dupin
