// Offset surfaces: base + distance · n, the derivatives of n by Taylor arithmetic.
#include "jets.h"
#include "taylor.h"

namespace dupin {
namespace {

/// The series of Su × Sv, from the derivatives of S to one order more.
void normal_series(const Vec3* base, int order, Vec3* normal) {
  Vec3 su[jet_size(kMaxOrder)], sv[jet_size(kMaxOrder)];
  for (int n = 0; n <= order; ++n)
    for (int j = 0; j <= n; ++j) {
      su[jet_index(n - j, j)] = base[jet_index(n - j + 1, j)];
      sv[jet_index(n - j, j)] = base[jet_index(n - j, j + 1)];
    }
  to_series(order, su);
  to_series(order, sv);
  multiply_series(order, su, sv, normal, [](const Vec3& a, const Vec3& b) { return cross(a, b); });
}

bool vanishes(const Vec3& normal, const Vec3* base) {
  return !(length(normal) > 1e-14 * length(base[1]) * length(base[2])) ||
         !(length(base[1]) > 1e-14 * length(base[4])) || !(length(base[2]) > 1e-14 * length(base[4]));
}

/// Where the base's normal vanishes: the limit towards the middle of the domain, and no derivatives.
void evaluate_singular(const OffsetSurface& surface, double u, double v, int order, const Vec3& p,
                       Vec3* out) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < jet_size(order); ++k) out[k] = {nan, nan, nan};
  Box2 box = domain(*surface.base);
  const auto middle = [](double lo, double hi, double at) {
    return std::isfinite(lo) && std::isfinite(hi) ? 0.5 * (lo + hi) : at < 1 ? at + 1 : at - 1;
  };
  const Vec2 inside{middle(box.lo.x, box.hi.x, u), middle(box.lo.y, box.hi.y, v)};
  out[0] = p + principal_curvature(*surface.base, u, v, inside).n * surface.distance;
}

}  // namespace

void evaluate_into(const OffsetSurface& surface, double u, double v, int order, Vec3* out, Sides sides) {
  if (order >= kMaxOrder) {  // an offset of offsets deeper than the orders reach
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < jet_size(order); ++k) out[k] = {nan, nan, nan};
    return;
  }
  const int base_order = std::max(order + 1, 2);
  Vec3 base[jet_size(kMaxOrder)], normal[jet_size(kMaxOrder)], unit[jet_size(kMaxOrder)];
  evaluate_into(*surface.base, u, v, base_order, base, sides);
  normal_series(base, order, normal);
  if (vanishes(normal[0], base)) return evaluate_singular(surface, u, v, order, base[0], out);
  normalize_series(order, normal, unit);
  to_derivatives(order, unit);
  for (int k = 0; k < jet_size(order); ++k) out[k] = base[k] + unit[k] * surface.distance;
}

}  // namespace dupin
