// Bounds of a patch's principal curvatures: they are the values of II / I over all directions.
//
// Every coefficient of the two forms is a quotient of polynomials, which is within a computed radius of its
// value in the patch's middle: the radius is the largest quotient of Bernstein coefficients of what differs.
// In the middle's own orthonormal frame the forms are then bounded for all directions at once.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bounds.h"
#include "homogeneous.h"
#include "tensor.h"

namespace dupin {
namespace {

/// Of the polynomials' coefficients, in parts of their size.
constexpr double kRounding = 1e-13;

struct Interval {
  double centre = 0, radius = 0;
};

double middle_value(const Tensor& a) {
  double sum = 0;
  for (double c : a.c) sum += c;
  return std::ldexp(sum, -(a.p + a.q));
}

/// num / den over the patch; den's coefficients must be positive.
Interval quotient(const Tensor& num, const Tensor& den) {
  const int p = std::max(num.p, den.p), q = std::max(num.q, den.q);
  const Tensor n = raised(num, p, q), d = raised(den, p, q);
  const double centre = middle_value(num) / middle_value(den);
  const double size = largest_quotient(n, d);
  return {centre, largest_quotient(n - d * centre, d) + kRounding * size};
}

Tensor dot(const std::array<Tensor, 3>& a, const std::array<Tensor, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Coefficients of a symmetric form, of ∂u², ∂u∂v and ∂v².
struct Form {
  Interval uu, uv, vv;
};

struct Forms {
  Form first, second;  ///< the second one times |Su × Sv|
  Interval area;       ///< |Su × Sv|
};

std::array<Tensor, 3> derivative(const std::array<Tensor, 3>& x, Tensor (*along)(const Tensor&)) {
  return {along(x[0]), along(x[1]), along(x[2])};
}

/// w² Su from Xu and wu.
std::array<Tensor, 3> tangent(const HomogeneousTensors& t, const std::array<Tensor, 3>& derived,
                              const Tensor& w) {
  std::array<Tensor, 3> out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = t.w * derived[c] - t.x[c] * w;
  return out;
}

Interval length_of(const std::array<Tensor, 3>& n, const Tensor& w3) {
  Vec3 centre, radius;
  for (int c = 0; c < 3; ++c) {
    const Interval i = quotient(n[static_cast<std::size_t>(c)], w3);
    centre[c] = i.centre, radius[c] = i.radius;
  }
  return {length(centre), length(radius)};
}

Forms forms_of(const BezierPatch& patch) {
  Frame3 frame;
  frame.origin = homogeneous::projected(patch.pole(patch.degree_u / 2, patch.degree_v / 2));
  const HomogeneousTensors t = homogeneous_tensors(patch, frame);
  const auto xu = derivative(t.x, derivative_u), xv = derivative(t.x, derivative_v);
  const Tensor wu = derivative_u(t.w), wv = derivative_v(t.w);
  const auto n = normal_tensors(t, patch.rational);
  Tensor one(0, 0);
  one.c[0] = 1;
  Forms out;
  if (!patch.rational) {
    out.first = {quotient(dot(xu, xu), one), quotient(dot(xu, xv), one), quotient(dot(xv, xv), one)};
    out.second = {quotient(dot(derivative(xu, derivative_u), n), one),
                  quotient(dot(derivative(xu, derivative_v), n), one),
                  quotient(dot(derivative(xv, derivative_v), n), one)};
    out.area = length_of(n, one);
    return out;
  }
  const Tensor w2 = t.w * t.w, w4 = w2 * w2;
  const auto su = tangent(t, xu, wu), sv = tangent(t, xv, wv);
  out.first = {quotient(dot(su, su), w4), quotient(dot(su, sv), w4), quotient(dot(sv, sv), w4)};
  // w⁴ Suu · (Su × Sv) = Xuu · n − wuu X · (Xu × Xv), with n = w³ Su × Sv.
  Tensor volume = t.x[0] * (xu[1] * xv[2] - xu[2] * xv[1]) + t.x[1] * (xu[2] * xv[0] - xu[0] * xv[2]) +
                  t.x[2] * (xu[0] * xv[1] - xu[1] * xv[0]);
  const auto second = [&](const std::array<Tensor, 3>& x, const Tensor& w) {
    return quotient(dot(x, n) - volume * w, w4);
  };
  out.second = {second(derivative(xu, derivative_u), derivative_u(wu)),
                second(derivative(xu, derivative_v), derivative_v(wu)),
                second(derivative(xv, derivative_v), derivative_v(wv))};
  out.area = length_of(n, w2 * t.w);
  return out;
}

/// J⁻ᵀ F J⁻¹ for the Cholesky factor J = [a b; 0 d] of the first form in the middle, entry by entry; and how
/// much of it the radii may be, as a matrix norm.
struct InFrame {
  double w11 = 0, w12 = 0, w22 = 0, off = 0;
};

InFrame in_frame(const Form& form, double a, double slope, double d) {
  InFrame out;
  out.w11 = form.uu.centre / (a * a);
  out.w12 = (form.uv.centre - slope * form.uu.centre) / (a * d);
  out.w22 = (form.vv.centre - slope * (2 * form.uv.centre - slope * form.uu.centre)) / (d * d);
  const double s = std::abs(slope), r11 = form.uu.radius / (a * a),
               r12 = (form.uv.radius + s * form.uu.radius) / (a * d),
               r22 = (form.vv.radius + s * (2 * form.uv.radius + s * form.uu.radius)) / (d * d);
  out.off = std::sqrt(r11 * r11 + 2 * r12 * r12 + r22 * r22);
  return out;
}

}  // namespace

CurvatureBounds curvature_bounds(const BezierPatch& patch) {
  const CurvatureBounds unknown;
  if (patch.rational && 4 * std::max(patch.degree_u, patch.degree_v) > kMaxTensorDegree) return unknown;
  for (const Vec4& pole : patch.poles)
    if (!(pole.w > 0)) return unknown;
  const Forms forms = forms_of(patch);
  const double e = forms.first.uu.centre, slope = forms.first.uv.centre / e,
               rest = forms.first.vv.centre - slope * forms.first.uv.centre;
  if (!(e > 0) || !(rest > 0)) return unknown;
  const double a = std::sqrt(e), d = std::sqrt(rest);
  const InFrame first = in_frame(forms.first, a, slope, d), second = in_frame(forms.second, a, slope, d);
  const double area_lo = forms.area.centre - forms.area.radius,
               area_hi = forms.area.centre + forms.area.radius;
  // The first form is the identity but for `off` and rounding.
  const double off = first.off + kRounding;
  if (!(off < 1) || !(area_lo > 0)) return unknown;
  const double mean = 0.5 * (second.w11 + second.w22),
               r = std::hypot(0.5 * (second.w11 - second.w22), second.w12);
  const double slack = second.off + kRounding * (std::abs(mean) + r);
  const double lo = mean - r - slack, hi = mean + r + slack;
  CurvatureBounds out;
  out.lo = lo / (lo < 0 ? (1 - off) * area_lo : (1 + off) * area_hi);
  out.hi = hi / (hi > 0 ? (1 - off) * area_lo : (1 + off) * area_hi);
  return out;
}

}  // namespace dupin
