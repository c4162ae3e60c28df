#include "hundred_digits.h"

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace dupin::bench {
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
Vec3 rounded(const Point& p) {
  return {p.x.convert_to<double>(), p.y.convert_to<double>(), p.z.convert_to<double>()};
}

/// The basis functions that are not zero at t, and their first two derivatives.
struct Basis {
  std::size_t first = 0;
  std::array<std::vector<Real>, 3> values;
};

/// Those of degree p by Cox and de Boor's recursion.
std::vector<Real> functions(const std::vector<double>& knots, std::size_t span, int p, const Real& t) {
  std::vector<Real> n{1};
  for (int q = 1; q <= p; ++q) {
    std::vector<Real> next(static_cast<std::size_t>(q) + 1, Real(0));
    for (int i = 0; i < q; ++i) {
      const std::size_t k = span + static_cast<std::size_t>(i) + 1 - static_cast<std::size_t>(q);
      const Real lo = knots[k], hi = knots[k + static_cast<std::size_t>(q)];
      const Real part = n[static_cast<std::size_t>(i)] / (hi - lo);
      next[static_cast<std::size_t>(i)] += (hi - t) * part;
      next[static_cast<std::size_t>(i) + 1] += (t - lo) * part;
    }
    n = std::move(next);
  }
  return n;
}

/// From coefficients by functions of one degree less to those of degree p: the derivative's formula.
std::vector<Real> differentiated(const std::vector<double>& knots, std::size_t span, int p,
                                 const std::vector<Real>& lower) {
  std::vector<Real> out(static_cast<std::size_t>(p) + 1, Real(0));
  for (int i = 0; i < p; ++i) {
    const std::size_t k = span + static_cast<std::size_t>(i) + 1 - static_cast<std::size_t>(p);
    const Real part = lower[static_cast<std::size_t>(i)] * p /
                      (Real(knots[k + static_cast<std::size_t>(p)]) - Real(knots[k]));
    out[static_cast<std::size_t>(i)] -= part;
    out[static_cast<std::size_t>(i) + 1] += part;
  }
  return out;
}

Basis basis_at(const std::vector<double>& knots, int degree, std::size_t count, double at) {
  std::size_t span = static_cast<std::size_t>(degree);
  while (span + 1 < count && at >= knots[span + 1]) ++span;
  const Real t = at;
  Basis basis;
  basis.first = span - static_cast<std::size_t>(degree);
  basis.values[0] = functions(knots, span, degree, t);
  basis.values[1] = differentiated(knots, span, degree, functions(knots, span, degree - 1, t));
  basis.values[2].assign(static_cast<std::size_t>(degree) + 1, Real(0));
  if (degree >= 2)
    basis.values[2] = differentiated(
        knots, span, degree, differentiated(knots, span, degree - 1, functions(knots, span, degree - 2, t)));
  return basis;
}

struct Homogeneous {
  Point a;
  Real w = 0;
  void add(const Homogeneous& other, const Real& s) {
    a = a + other.a * s;
    w += other.w * s;
  }
};

/// h[i][j]: differentiated i times by u, j times by v, i + j <= 2.
using HomogeneousJet = std::array<std::array<Homogeneous, 3>, 3>;

HomogeneousJet homogeneous_jet(const BsplineSurface& s, double u, double v) {
  const Basis bu = basis_at(s.knots_u, s.degree_u, static_cast<std::size_t>(s.count_u), u),
              bv = basis_at(s.knots_v, s.degree_v, static_cast<std::size_t>(s.count_v), v);
  HomogeneousJet out;
  for (std::size_t i = 0; i < bu.values[0].size(); ++i) {
    std::array<Homogeneous, 3> row;
    for (std::size_t j = 0; j < bv.values[0].size(); ++j) {
      const std::size_t pole = (bu.first + i) * static_cast<std::size_t>(s.count_v) + bv.first + j;
      const Vec3& p = s.poles[pole];
      const Real w = s.weights.empty() ? 1 : s.weights[pole];
      const Homogeneous h{{p.x * w, p.y * w, p.z * w}, w};
      for (std::size_t k = 0; k < 3; ++k) row[k].add(h, bv.values[k][j]);
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; k + l < 3; ++l) out[k][l].add(row[l], bu.values[k][i]);
  }
  return out;
}

struct Jet {
  Point pu, pv, puu, puv, pvv;
};

Jet projected(const HomogeneousJet& h) {
  const Real inverse = 1 / h[0][0].w;
  const Point p = h[0][0].a * inverse;
  Jet jet;
  jet.pu = (h[1][0].a - p * h[1][0].w) * inverse;
  jet.pv = (h[0][1].a - p * h[0][1].w) * inverse;
  jet.puu = (h[2][0].a - p * h[2][0].w - jet.pu * (2 * h[1][0].w)) * inverse;
  jet.puv = (h[1][1].a - p * h[1][1].w - jet.pu * h[0][1].w - jet.pv * h[1][0].w) * inverse;
  jet.pvv = (h[0][2].a - p * h[0][2].w - jet.pv * (2 * h[0][1].w)) * inverse;
  return jet;
}

}  // namespace

ExactCurvature exact_curvature(const BsplineSurface& surface, double u, double v) {
  const Jet jet = projected(homogeneous_jet(surface, u, v));
  const Point normal = cross(jet.pu, jet.pv);
  const Real e = dot(jet.pu, jet.pu), f = dot(jet.pu, jet.pv), g = dot(jet.pv, jet.pv),
             area2 = dot(normal, normal);
  ExactCurvature out;
  if (area2 == 0) return out;
  out.regular = true;
  const Real area = sqrt(area2);
  const Point n = normal * (1 / area);
  const Real l = dot(jet.puu, n), m = dot(jet.puv, n), nn = dot(jet.pvv, n);
  const Real mean = (e * nn - 2 * f * m + g * l) / (2 * area2), gauss = (l * nn - m * m) / area2;
  Real root2 = mean * mean - gauss;
  if (root2 < 0) root2 = 0;
  const Real root = sqrt(root2), k1 = mean >= 0 ? mean + root : mean - root,
             k2 = mean >= 0 ? mean - root : mean + root;
  // (II − k1 I) (x, y) = 0: of its two rows the larger.
  const Real a = l - k1 * e, b = m - k1 * f, c = nn - k1 * g;
  const bool first = a * a + b * b >= b * b + c * c;
  Point d = first ? jet.pu * b - jet.pv * a : jet.pu * c - jet.pv * b;
  const Real size = sqrt(dot(d, d));
  if (size > 0) d = d * (1 / size);
  out.n = rounded(n), out.d1 = rounded(d);
  out.k1 = k1.convert_to<double>(), out.k2 = k2.convert_to<double>();
  const Real along = sqrt(e), across = area / along;
  const Real scale = sqrt(dot(jet.puu, jet.puu)) / e + sqrt(dot(jet.puv, jet.puv)) / (along * across) +
                     sqrt(dot(jet.pvv, jet.pvv)) / (across * across);
  out.condition = k1 != 0 ? (scale / abs(k1)).convert_to<double>() : std::numeric_limits<double>::infinity();
  return out;
}

}  // namespace dupin::bench
