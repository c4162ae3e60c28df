#include "oracle.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <functional>
#include <map>
#include <utility>

namespace dupin::oracle {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                           boost::multiprecision::et_off>;

struct Point {
  Real x = 0, y = 0, z = 0;
};
Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Point operator*(const Point& a, const Real& s) {
  return {a.x * s, a.y * s, a.z * s};
}
Real dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Real norm(const Point& a) {
  return sqrt(dot(a, a));
}
Point exact(const Vec3& p) {
  return {p.x, p.y, p.z};
}
Point exact(const Vec2& p) {
  return {p.x, p.y, 0};
}
Vec3 rounded(const Point& p) {
  return {p.x.convert_to<double>(), p.y.convert_to<double>(), p.z.convert_to<double>()};
}

/// N of index i and degree p at t, as Cox and de Boor define it.
class Basis {
 public:
  Basis(const std::vector<double>& knots, Real t, Side side) : knots_(knots), t_(std::move(t)), side_(side) {}
  Real operator()(int i, int p) {
    if (p == 0) return inside(i) ? 1 : 0;
    const auto key = std::pair(i, p);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    Real sum = 0;
    if (knots_[i + p] > knots_[i])
      if (const Real n = (*this)(i, p - 1); n != 0)
        sum += (t_ - knots_[i]) / (Real(knots_[i + p]) - knots_[i]) * n;
    if (knots_[i + p + 1] > knots_[i + 1])
      if (const Real n = (*this)(i + 1, p - 1); n != 0)
        sum += (knots_[i + p + 1] - t_) / (Real(knots_[i + p + 1]) - knots_[i + 1]) * n;
    return known_[key] = sum;
  }

 private:
  bool inside(int i) const {
    return side_ == Side::backward ? t_ > knots_[i] && t_ <= knots_[i + 1]
                                   : t_ >= knots_[i] && t_ < knots_[i + 1];
  }
  const std::vector<double>& knots_;
  Real t_;
  Side side_;
  std::map<std::pair<int, int>, Real> known_;
};

template <class V>
Point position(const CurveOf<V>& curve, const Real& t, Side side);

template <class V>
struct CurvePosition {
  const Real& t;
  Side side;
  Point operator()(const LineOf<V>& l) const { return exact(l.origin) + exact(l.direction) * t; }
  Point conic(const V& c, const V& x, const V& y, const Real& a, const Real& b) const {
    return exact(c) + exact(x) * a + exact(y) * b;
  }
  Point operator()(const CircleOf<V>& c) const {
    return conic(c.center, c.x, c.y, c.radius * cos(t), c.radius * sin(t));
  }
  Point operator()(const EllipseOf<V>& e) const {
    return conic(e.center, e.x, e.y, e.major * cos(t), e.minor * sin(t));
  }
  Point operator()(const ParabolaOf<V>& p) const {
    return conic(p.vertex, p.x, p.y, t * t / (4 * Real(p.focal)), t);
  }
  Point operator()(const HyperbolaOf<V>& h) const {
    return conic(h.center, h.x, h.y, h.major * cosh(t), h.minor * sinh(t));
  }
  Point operator()(const BsplineOf<V>& s) const {
    Basis basis(s.knots, t, side);
    Point numerator;
    Real denominator = 0;
    for (std::size_t i = 0; i < s.poles.size(); ++i) {
      const Real n = basis(static_cast<int>(i), s.degree) * (s.weights.empty() ? 1 : s.weights[i]);
      numerator = numerator + exact(s.poles[i]) * n;
      denominator += n;
    }
    return numerator * (1 / denominator);
  }
  Point operator()(const OffsetCurveOf<V>& o) const {
    const Real h = Real("1e-33");
    const Point tangent = (position(*o.base, t + h, side) - position(*o.base, t - h, side)) * (1 / (2 * h));
    const Point clockwise{tangent.y, -tangent.x, 0};
    const Point aside = sizeof(V) == sizeof(Vec2) ? clockwise : cross(tangent, exact(o.reference));
    return position(*o.base, t, side) + aside * (o.distance / norm(aside));
  }
};

template <class V>
Point position(const CurveOf<V>& curve, const Real& t, Side side) {
  return std::visit(CurvePosition<V>{t, side}, curve.geometry);
}

Point position(const Surface& surface, const Real& u, const Real& v, Side side);

struct SurfacePosition {
  const Real &u, &v;
  Side side;
  static Point in_frame(const Frame3& f, const Real& x, const Real& y, const Real& z) {
    return exact(f.origin) + exact(f.x) * x + exact(f.y) * y + exact(f.z) * z;
  }
  Point round(const Frame3& f, const Real& radius, const Real& height) const {
    return in_frame(f, radius * cos(u), radius * sin(u), height);
  }
  Point operator()(const Plane& p) const { return in_frame(p.frame, u, v, 0); }
  Point operator()(const Cylinder& c) const { return round(c.frame, c.radius, v); }
  Point operator()(const Cone& c) const {
    return round(c.frame, c.radius + v * sin(Real(c.half_angle)), v * cos(Real(c.half_angle)));
  }
  Point operator()(const Sphere& s) const { return round(s.frame, s.radius * cos(v), s.radius * sin(v)); }
  Point operator()(const Torus& t) const {
    return round(t.frame, t.major + t.minor * cos(v), t.minor * sin(v));
  }
  Point operator()(const BsplineSurface& s) const {
    Basis basis_u(s.knots_u, u, side), basis_v(s.knots_v, v, side);
    std::vector<Real> along_v;
    for (int j = 0; j < s.count_v; ++j) along_v.push_back(basis_v(j, s.degree_v));
    Point numerator;
    Real denominator = 0;
    for (int i = 0; i < s.count_u; ++i) {
      const Real along_u = basis_u(i, s.degree_u);
      if (along_u == 0) continue;
      for (int j = 0; j < s.count_v; ++j) {
        if (along_v[j] == 0) continue;
        const std::size_t index = static_cast<std::size_t>(i * s.count_v + j);
        const Real n = along_u * along_v[j] * (s.weights.empty() ? 1 : s.weights[index]);
        numerator = numerator + exact(s.poles[index]) * n;
        denominator += n;
      }
    }
    return numerator * (1 / denominator);
  }
  // Rodrigues' formula, with the axis direction made unit to 100 digits.
  Point operator()(const Revolution& r) const {
    const Point axis = exact(r.axis_direction) * (1 / norm(exact(r.axis_direction)));
    const Point q = position(r.profile, v, side) - exact(r.axis_origin);
    return exact(r.axis_origin) + q * cos(u) + cross(axis, q) * sin(u) + axis * (dot(axis, q) * (1 - cos(u)));
  }
  Point operator()(const Extrusion& e) const { return position(e.profile, u, side) + exact(e.direction) * v; }
  Point operator()(const OffsetSurface& o) const {
    const Real h = Real("1e-33");
    const Point su = position(*o.base, u + h, v, side) - position(*o.base, u - h, v, side);
    const Point sv = position(*o.base, u, v + h, side) - position(*o.base, u, v - h, side);
    const Point n = cross(su, sv);
    return position(*o.base, u, v, side) + n * (o.distance / norm(n));
  }
};

Point position(const Surface& surface, const Real& u, const Real& v, Side side) {
  return std::visit(SurfacePosition{u, v, side}, surface.geometry);
}

/// The k-th derivative is Σ weight · f(offset · h) / hᵏ, to h² (central) or h.
struct StencilEntry {
  int offset;
  double weight;
};
std::vector<StencilEntry> stencil(int k, Side side) {
  if (side == Side::central) {
    static const std::vector<StencilEntry> kCentral[4] = {{{0, 1}},
                                                          {{-1, -0.5}, {1, 0.5}},
                                                          {{-1, 1}, {0, -2}, {1, 1}},
                                                          {{-2, -0.5}, {-1, 1}, {1, -1}, {2, 0.5}}};
    return kCentral[k];
  }
  static const std::vector<StencilEntry> kForward[4] = {
      {{0, 1}}, {{0, -1}, {1, 1}}, {{0, 1}, {1, -2}, {2, 1}}, {{0, -1}, {1, 3}, {2, -3}, {3, 1}}};
  std::vector<StencilEntry> entries = kForward[k];
  if (side == Side::backward)
    for (StencilEntry& e : entries) e.offset = -e.offset, e.weight = k % 2 ? -e.weight : e.weight;
  return entries;
}

// Offsets differentiate inside with a step of 1e-33 already, which leaves 66 digits; third differences take
// 36 of them.
Real step(Side side) {
  return side == Side::central ? Real("1e-12") : Real("1e-20");
}

Real power(const Real& h, int k) {
  Real p = 1;
  for (int i = 0; i < k; ++i) p *= h;
  return p;
}

class Differences {
 public:
  Differences(const Surface& surface, double u, double v, Side side)
      : surface_(surface), u_(u), v_(v), h_(step(side)), side_(side) {}
  Point operator()(int i, int j) {
    Point sum;
    for (const StencilEntry& a : stencil(i, side_))
      for (const StencilEntry& b : stencil(j, side_))
        sum = sum + at(a.offset, b.offset) * Real(a.weight * b.weight);
    return sum * (1 / power(h_, i + j));
  }

 private:
  const Point& at(int a, int b) {
    const auto key = std::pair(a, b);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_[key] = position(surface_, u_ + a * h_, v_ + b * h_, side_);
  }
  const Surface& surface_;
  Real u_, v_, h_;
  Side side_;
  std::map<std::pair<int, int>, Point> known_;
};

template <class V>
std::array<Point, 4> curve_differences(const CurveOf<V>& curve, double t, Side side) {
  const Real h = step(side);
  std::array<Point, 4> d;
  for (int k = 0; k < 4; ++k) {
    for (const StencilEntry& e : stencil(k, side))
      d[k] = d[k] + position(curve, t + e.offset * h, side) * Real(e.weight);
    d[k] = d[k] * (1 / power(h, k));
  }
  return d;
}

}  // namespace

SurfaceJet surface_jet(const Surface& surface, double u, double v, Side side) {
  Differences d(surface, u, v, side);
  const auto get = [&d](int i, int j) { return rounded(d(i, j)); };
  return {get(0, 0), get(1, 0), get(0, 1), get(2, 0), get(1, 1),
          get(0, 2), get(3, 0), get(2, 1), get(1, 2), get(0, 3)};
}

std::array<Vec3, 4> curve_jet(const Curve3& curve, double t, Side side) {
  const auto d = curve_differences(curve, t, side);
  return {rounded(d[0]), rounded(d[1]), rounded(d[2]), rounded(d[3])};
}

std::array<Vec2, 4> curve_jet(const Curve2& curve, double t, Side side) {
  std::array<Vec2, 4> out;
  const auto d = curve_differences(curve, t, side);
  for (int k = 0; k < 4; ++k) out[k] = {rounded(d[k]).x, rounded(d[k]).y};
  return out;
}

PrincipalCurvatures curvatures(const Surface& surface, double u, double v) {
  Differences s(surface, u, v, Side::central);
  const Point su = s(1, 0), sv = s(0, 1), suu = s(2, 0), suv = s(1, 1), svv = s(0, 2);
  const Point normal = cross(su, sv), n = normal * (1 / norm(normal));
  const Real E = dot(su, su), F = dot(su, sv), G = dot(sv, sv), L = dot(suu, n), M = dot(suv, n),
             N = dot(svv, n);
  const Real area2 = E * G - F * F;
  const Real mean = (E * N - 2 * F * M + G * L) / (2 * area2), gauss = (L * N - M * M) / area2;
  const Real under = mean * mean - gauss, r = under > 0 ? Real(sqrt(under)) : Real(0);
  const Real k1 = mean >= 0 ? Real(mean + r) : Real(mean - r),
             k2 = mean >= 0 ? Real(mean - r) : Real(mean + r);
  // (II − k1 I)(x, y) = 0: the larger of the two rows.
  const Real a = L - k1 * E, b = M - k1 * F, c = N - k1 * G;
  Point d1 = abs(a) * G > abs(c) * E ? sv * a - su * b : su * c - sv * b;
  if (norm(d1) > 0) d1 = d1 * (1 / norm(d1));
  const Real lu = norm(su), across = sqrt(area2) / lu, slope = F / E;
  const Real t = abs(slope), scale = norm(suu) / E + (norm(suv) + t * norm(suu)) / (lu * across) +
                                     (norm(svv) + 2 * t * norm(suv) + t * t * norm(suu)) / (across * across);
  return {rounded(n), rounded(d1), k1.convert_to<double>(), k2.convert_to<double>(),
          scale.convert_to<double>()};
}

}  // namespace dupin::oracle
