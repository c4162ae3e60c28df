// Principal curvatures by the symmetric shape operator in an orthonormal tangent frame: a 2x2 symmetric
// eigenproblem, which keeps its digits where H ± sqrt(H² − K) loses half of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "precise.h"
#include "shape_operator.h"

namespace dupin {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Curvatures that differ by less than this part of the larger, or than their rounding, are one.
constexpr double kUmbilic = 1e-12;
/// |Su × Sv| below this part of |Su||Sv|: the two are one direction to rounding.
constexpr double kParallel = 1e-14;
/// |Su × Sv| below this part of what it is around the point: too few digits are left for second derivatives.
constexpr double kSingular = 1e-5;
/// The same, for splines to be evaluated in double-double arithmetic, which has digits enough.
constexpr double kImprecise = 1e-3;

/// a·b − c·d to nearly full precision (Kahan).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d, error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}
Vec3 accurate_cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}

/// With pu = a e1, pv = b e1 + d e2: W = J⁻ᵀ II J⁻¹, J = [a b; 0 d].
ShapeOperator shape_operator(const SurfaceJet& jet, const Vec3& normal) {
  ShapeOperator s;
  const double a = length(jet.pu), area = length(normal), d = area / a, slope = dot(jet.pu, jet.pv) / (a * a);
  s.n = normal / area;
  s.e1 = jet.pu / a;
  s.e2 = cross(s.n, s.e1);
  const double l = dot(jet.puu, s.n), m = dot(jet.puv, s.n), n = dot(jet.pvv, s.n);
  s.w11 = l / (a * a);
  s.w12 = (m - slope * l) / (a * d);
  s.w22 = (n - slope * (2 * m - slope * l)) / (d * d);
  const double lu = length(jet.puu), mu = length(jet.puv), nu = length(jet.pvv), t = std::abs(slope);
  s.noise = 8 * kEpsilon * (lu / (a * a) + (mu + t * lu) / (a * d) + (nu + t * (2 * mu + t * lu)) / (d * d));
  return s;
}

/// The first knot of (knots, t) that lies in the direction `way` from t, as a part of `way`; at most 1.
double reach_in_knots(const std::vector<double>& knots, int degree, bool periodic, double t, double way) {
  const double lo = knots[degree], hi = knots[knots.size() - degree - 1];
  if (periodic) t -= (hi - lo) * std::floor((t - lo) / (hi - lo));
  double reach = 1;
  const double least = 1e-12 * (hi - lo);
  for (double knot : knots)
    for (int turn = periodic ? -1 : 0; turn <= (periodic ? 1 : 0); ++turn) {
      const double ahead = (knot + turn * (hi - lo) - t) / way;
      if (ahead * std::abs(way) > least) reach = std::min(reach, ahead);
    }
  return reach;
}

double reach_in_curve(const Curve3& curve, double t, double way) {
  const double lo = std::min(t, t + way), hi = std::max(t, t + way);
  double reach = 1;
  for (double knot : breaks(curve, lo, hi, 100)) reach = std::min(reach, (knot - t) / way);
  return reach;
}

/// How much of the way from (u,v) along `way` crosses no knot line.
double smooth_reach(const Surface& surface, Vec2 uv, Vec2 way) {
  double reach = 1;
  if (const auto* s = std::get_if<BsplineSurface>(&surface.geometry)) {
    if (way.x != 0) reach = reach_in_knots(s->knots_u, s->degree_u, s->periodic_u, uv.x, way.x);
    if (way.y != 0)
      reach = std::min(reach, reach_in_knots(s->knots_v, s->degree_v, s->periodic_v, uv.y, way.y));
  } else if (const auto* revolution = std::get_if<Revolution>(&surface.geometry)) {
    if (way.y != 0) reach = reach_in_curve(revolution->profile, uv.y, way.y);
  } else if (const auto* extrusion = std::get_if<Extrusion>(&surface.geometry)) {
    if (way.x != 0) reach = reach_in_curve(extrusion->profile, uv.x, way.x);
  } else if (const auto* offset = std::get_if<OffsetSurface>(&surface.geometry)) {
    reach = smooth_reach(*offset->base, uv, way);
  }
  return reach;
}

// The limit is that of polynomials in h through h = reach/8 … reach/512 (Neville), of the normal and of the
// curvature tensor Σ kᵢ dᵢ dᵢᵀ in space, which unlike the directions is smooth in h. 1/h, which has no limit,
// shows by the last step's size.
constexpr int kNodes = 7;
constexpr double kFirstNode = 1.0 / 8;
constexpr double kConverged = 5e-3;

using LimitValues = std::array<double, 9>;  // the tensor's six components, then the normal

LimitValues limit_values(const Curvature& k) {
  const auto tensor = [&k](int i, int j) { return k.k1 * k.d1[i] * k.d1[j] + k.k2 * k.d2[i] * k.d2[j]; };
  return {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2),
          tensor(1, 2), k.n.x,        k.n.y,        k.n.z};
}

Curvature limit_curvature(const Surface& surface, Vec2 uv, Vec2 way, double extent) {
  std::array<LimitValues, kNodes> table;
  double largest = 0;
  Vec3 before;
  for (int i = 0; i < kNodes; ++i) {
    const Vec2 at = uv + way * std::ldexp(kFirstNode, -i);
    const Curvature k = principal_curvature(evaluate(surface, at.x, at.y, 2));
    if (k.kind == Curvature::Kind::undefined || (i > 0 && !(dot(k.n, before) > 0)))
      return undefined_curvature();
    before = k.n;
    table[i] = limit_values(k);
    largest = std::max(largest, std::abs(k.k1));
  }
  LimitValues last_step{};
  for (int level = 1; level < kNodes; ++level)
    for (int i = kNodes - 1; i >= level; --i)
      for (std::size_t c = 0; c < 9; ++c) {  // h halves from node to node
        const double step = (table[i][c] - table[i - 1][c]) / (std::ldexp(1.0, level) - 1);
        if (level == kNodes - 1) last_step[c] = step;
        table[i][c] += step;
      }
  const LimitValues& t = table[kNodes - 1];
  for (std::size_t c = 0; c < 9; ++c) {
    const double scale = c < 6 ? kConverged * largest + 1e-6 / extent : kConverged;
    if (!(std::abs(last_step[c]) <= scale)) return undefined_curvature();
  }
  ShapeOperator s;
  s.n = normalized({t[6], t[7], t[8]});
  s.e1 = any_perpendicular(s.n);
  s.e2 = cross(s.n, s.e1);
  const Mat3 tensor{{t[0], t[3], t[4]}, {t[3], t[1], t[5]}, {t[4], t[5], t[2]}};
  s.w11 = dot(s.e1, tensor * s.e1);
  s.w12 = dot(s.e1, tensor * s.e2);
  s.w22 = dot(s.e2, tensor * s.e2);
  s.noise = 1e-9 * largest;
  Curvature k = diagonalize(s);
  k.kind = Curvature::Kind::singular_limit;
  return k;
}

}  // namespace

Vec3 projected_axis(const Vec3& n) {
  int best = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(n[i]) < std::abs(n[best]) - 1e-12) best = i;
  Vec3 axis;
  axis[best] = 1;
  return normalized(axis - n * n[best]);
}

Curvature undefined_curvature() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {{nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan, nan, Curvature::Kind::undefined};
}

Curvature diagonalize(const ShapeOperator& s) {
  Curvature k;
  k.n = s.n;
  const double mean = 0.5 * (s.w11 + s.w22), half = 0.5 * (s.w11 - s.w22), r = std::hypot(half, s.w12);
  if (r <= kUmbilic * std::abs(mean) + s.noise) {
    k.kind = Curvature::Kind::umbilic;
    k.d1 = projected_axis(s.n);
    k.d2 = cross(s.n, k.d1);
    k.k1 = k.k2 = mean;
    return k;
  }
  // The eigenvector of mean + sign·r, written so that nothing cancels; the other value from the determinant.
  const double sign = mean >= 0 ? 1 : -1, along = sign * half;
  const double x = along >= 0 ? r + along : sign * s.w12, y = along >= 0 ? sign * s.w12 : r - along;
  k.d1 = normalized(s.e1 * x + s.e2 * y);
  k.d2 = cross(s.n, k.d1);
  k.k1 = mean + sign * r;
  k.k2 = (s.w11 * s.w22 - s.w12 * s.w12) / k.k1;
  return k;
}

Curvature principal_curvature(const SurfaceJet& jet) {
  const double a = length(jet.pu), b = length(jet.pv);
  Vec3 normal = cross(jet.pu, jet.pv);
  if (length(normal) < 1e-3 * a * b) normal = accurate_cross(jet.pu, jet.pv);
  const double area = length(normal);
  if (!(area > kParallel * a * b) || !(area > 0) || !std::isfinite(area)) return undefined_curvature();
  return diagonalize(shape_operator(jet, normal));
}

Curvature principal_curvature(const Surface& surface, double u, double v, Vec2 inside) {
  const SurfaceJet jet = evaluate(surface, u, v, 2);
  const Vec2 uv{u, v};
  Vec2 way = inside - uv;
  way = way * smooth_reach(surface, uv, way);
  // What |Su| and |Sv| grow to along the way, by Taylor: |Su × Sv| is small or not beside their product.
  const double du = std::abs(way.x), dv = std::abs(way.y);
  const double grown = (length(jet.pu) + length(jet.puu) * du + length(jet.puv) * dv) *
                       (length(jet.pv) + length(jet.puv) * du + length(jet.pvv) * dv);
  const double area = length(cross(jet.pu, jet.pv));
  if (!(area > kImprecise * grown))
    if (const auto* spline = std::get_if<BsplineSurface>(&surface.geometry))
      if (const auto precise = precise_curvature(precise_jet(*spline, u, v, 2))) return *precise;
  if (area > kSingular * grown || (du == 0 && dv == 0)) return principal_curvature(jet);
  const Vec2 middle = uv + way * 0.5;
  const SurfaceJet ahead = evaluate(surface, middle.x, middle.y, 1);
  if (!(length(cross(ahead.pu, ahead.pv)) > 100 * area)) return principal_curvature(jet);
  return limit_curvature(surface, uv, way, distance(ahead.p, jet.p));
}

}  // namespace dupin
