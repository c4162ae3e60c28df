#include "curve.h"

#include <algorithm>
#include <numbers>

#include "jets.h"
#include "knots.h"
#include "taylor.h"

namespace dupin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class V>
void evaluate_kind(const LineOf<V>& line, double t, int order, V* out, bool) {
  for (int k = 0; k <= order; ++k) out[k] = V{};
  out[0] = line.origin + line.direction * t;
  if (order >= 1) out[1] = line.direction;
}

template <class V>
void evaluate_conic(const V& center, const V& a, const V& b, double t, int order, V* out) {
  const TrigJet trig(t, order);
  for (int k = 0; k <= order; ++k) out[k] = a * trig.c[k] + b * trig.s[k];
  out[0] = center + out[0];
}

template <class V>
void evaluate_kind(const CircleOf<V>& c, double t, int order, V* out, bool) {
  evaluate_conic(c.center, c.x * c.radius, c.y * c.radius, t, order, out);
}

template <class V>
void evaluate_kind(const EllipseOf<V>& e, double t, int order, V* out, bool) {
  evaluate_conic(e.center, e.x * e.major, e.y * e.minor, t, order, out);
}

template <class V>
void evaluate_kind(const ParabolaOf<V>& p, double t, int order, V* out, bool) {
  for (int k = 0; k <= order; ++k) out[k] = V{};
  out[0] = p.vertex + (p.x * (t * t / (4 * p.focal)) + p.y * t);
  if (order >= 1) out[1] = p.x * (t / (2 * p.focal)) + p.y;
  if (order >= 2) out[2] = p.x * (1 / (2 * p.focal));
}

template <class V>
void evaluate_kind(const HyperbolaOf<V>& h, double t, int order, V* out, bool) {
  const double c = std::cosh(t), s = std::sinh(t);
  const V even = h.x * (h.major * c) + h.y * (h.minor * s), odd = h.x * (h.major * s) + h.y * (h.minor * c);
  for (int k = 0; k <= order; ++k) out[k] = k % 2 == 0 ? even : odd;
  out[0] = h.center + even;
}

/// Sums relative to an active pole, as for surfaces (bspline_surface.cpp).
template <class V>
void evaluate_kind(const BsplineOf<V>& s, double t, int order, V* out, bool from_left) {
  const int p = s.degree, n = static_cast<int>(s.poles.size());
  t = into_domain(t, s.knots[p], s.knots[n], s.periodic, from_left);
  const int span = find_span(s.knots, p, t, from_left);
  double basis[(kMaxOrder + 1) * (kMaxDegree + 1)];
  basis_derivatives(s.knots, p, span, t, order, basis);
  const V reference = s.poles[span - p / 2];
  double w[kMaxOrder + 1] = {};
  for (int k = 0; k <= order; ++k) out[k] = V{};
  for (int j = 0; j <= p; ++j) {
    const V offset = s.poles[span - p + j] - reference;
    const double weight = s.weights.empty() ? 1 : s.weights[span - p + j];
    for (int k = 0; k <= order; ++k) {
      const double b = basis[k * (p + 1) + j] * weight;
      out[k] += offset * b;
      w[k] += b;
    }
  }
  if (!s.weights.empty())
    for (int k = 0; k <= order; ++k) {
      for (int i = 1; i <= k; ++i) out[k] = out[k] - out[k - i] * (kBinomial[k][i] * w[i]);
      out[k] = out[k] / w[0];
    }
  out[0] += reference;
}

/// The vector that the offset goes along, before normalisation, as a vector in space.
Vec3 offset_side(const Vec2& tangent, const Vec3&) {
  return {tangent.y, -tangent.x, 0};
}
Vec3 offset_side(const Vec3& tangent, const Vec3& reference) {
  return cross(tangent, reference);
}
void add_side(Vec2& p, const Vec3& side) {
  p += Vec2{side.x, side.y};
}
void add_side(Vec3& p, const Vec3& side) {
  p += side;
}

template <class V>
void evaluate_kind(const OffsetCurveOf<V>& offset, double t, int order, V* out, bool from_left) {
  V base[kMaxOrder + 2];
  const int known = std::min(order + 1, kMaxOrder);
  evaluate_into(*offset.base, t, known, base, from_left);
  // A curve's series is a surface's that does not depend on v.
  Vec3 side[jet_size(kMaxOrder)], unit[jet_size(kMaxOrder)];
  for (int k = 0; k < known; ++k)
    side[jet_index(k, 0)] = offset_side(base[k + 1], offset.reference) / kFactorial[k];
  normalize_series(known - 1, side, unit);
  for (int k = 0; k <= order; ++k) {
    out[k] = base[std::min(k, known)];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    add_side(out[k],
             k < known ? unit[jet_index(k, 0)] * (offset.distance * kFactorial[k]) : Vec3{nan, nan, nan});
  }
}

template <class V>
CurveJet<V> evaluate_public(const CurveOf<V>& curve, double t, int order) {
  CurveJet<V> jet{};
  evaluate_into(curve, t, std::clamp(order, 0, 3), jet.data());
  return jet;
}

/// Knots of multiplicity m leave degree − m derivatives continuous.
template <class V>
void spline_breaks(const BsplineOf<V>& s, double t0, double t1, int continuity, std::vector<double>& out) {
  const int p = s.degree, n = static_cast<int>(s.poles.size());
  const double lo = s.knots[p], hi = s.knots[n], length = hi - lo;
  const double first = s.periodic ? std::floor((t0 - lo) / length) : 0;
  const double last = s.periodic ? std::floor((t1 - lo) / length) : 0;
  for (double turn = first; turn <= last; ++turn)
    for (std::size_t i = 0; i < s.knots.size();) {
      std::size_t next = i;
      while (next < s.knots.size() && s.knots[next] == s.knots[i]) ++next;
      const double t = s.knots[i] + turn * length;
      const bool inside =
          s.periodic ? s.knots[i] >= lo && s.knots[i] < hi : s.knots[i] > lo && s.knots[i] < hi;
      if (inside && t > t0 && t < t1 && p - static_cast<int>(next - i) < continuity) out.push_back(t);
      i = next;
    }
}

template <class V>
std::vector<double> breaks_of(const CurveOf<V>& curve, double t0, double t1, int continuity) {
  std::vector<double> out;
  if (const auto* spline = std::get_if<BsplineOf<V>>(&curve.geometry))
    spline_breaks(*spline, t0, t1, continuity, out);
  else if (const auto* offset = std::get_if<OffsetCurveOf<V>>(&curve.geometry))
    out = breaks_of(*offset->base, t0, t1, continuity + 1);
  return out;
}

template <class V>
ParameterRange domain_of(const CurveOf<V>& curve) {
  switch (curve.geometry.index()) {
    case 1:
    case 2:
      return {0, 2 * std::numbers::pi};
    case 5: {
      const auto& s = std::get<BsplineOf<V>>(curve.geometry);
      return {s.knots[s.degree], s.knots[s.poles.size()]};
    }
    case 6:
      return domain_of(*std::get<OffsetCurveOf<V>>(curve.geometry).base);
    default:
      return {-kInfinity, kInfinity};
  }
}

template <class V>
double period_of(const CurveOf<V>& curve) {
  if (const auto* offset = std::get_if<OffsetCurveOf<V>>(&curve.geometry)) return period_of(*offset->base);
  const auto* spline = std::get_if<BsplineOf<V>>(&curve.geometry);
  const bool closes = spline ? spline->periodic : curve.geometry.index() == 1 || curve.geometry.index() == 2;
  const ParameterRange range = domain_of(curve);
  return closes ? range.hi - range.lo : 0;
}

}  // namespace

void evaluate_into(const Curve2& curve, double t, int order, Vec2* out, bool from_left) {
  std::visit([&](const auto& geometry) { evaluate_kind(geometry, t, order, out, from_left); },
             curve.geometry);
}
void evaluate_into(const Curve3& curve, double t, int order, Vec3* out, bool from_left) {
  std::visit([&](const auto& geometry) { evaluate_kind(geometry, t, order, out, from_left); },
             curve.geometry);
}

CurveJet<Vec2> evaluate(const Curve2& curve, double t, int order) {
  return evaluate_public(curve, t, order);
}
CurveJet<Vec3> evaluate(const Curve3& curve, double t, int order) {
  return evaluate_public(curve, t, order);
}

std::vector<double> breaks(const Curve2& curve, double t0, double t1, int continuity) {
  return breaks_of(curve, t0, t1, continuity);
}
std::vector<double> breaks(const Curve3& curve, double t0, double t1, int continuity) {
  return breaks_of(curve, t0, t1, continuity);
}

ParameterRange domain(const Curve2& curve) {
  return domain_of(curve);
}
ParameterRange domain(const Curve3& curve) {
  return domain_of(curve);
}
double period(const Curve2& curve) {
  return period_of(curve);
}
double period(const Curve3& curve) {
  return period_of(curve);
}

}  // namespace dupin
