#include "precise.h"

#include "knots.h"
#include "shape_operator.h"

namespace dupin {
namespace {

using Number = DoubleDouble;
using Triple = std::array<Number, 3>;

/// |Su × Sv| below this part of the sums that it is made of: nothing is left of it.
constexpr double kVanished = 1e-22;

Number dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Triple scaled(const Triple& a, const Number& s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
Vec3 rounded(const Triple& a) {
  return {a[0].hi, a[1].hi, a[2].hi};
}

double size(const Triple& a) {
  return length(rounded(a));
}

/// Values and derivatives of the basis, as basis_derivatives in knots.cpp.
struct Basis {
  Number values[4][kMaxDegree + 1];

  Basis(const std::vector<double>& knots, int p, int span, double t, int order) {
    Number triangle[kMaxDegree + 1][kMaxDegree + 1];
    const auto knot = [&](int i) { return Number(knots[static_cast<std::size_t>(i)]); };
    triangle[0][0] = 1.0;
    for (int q = 1; q <= p; ++q) {
      Number saved = 0.0;
      for (int r = 0; r < q; ++r) {
        const Number lo = knot(span + 1 - q + r), hi = knot(span + 1 + r);
        const Number term = triangle[q - 1][r] / (hi - lo);
        triangle[q][r] = saved + (hi - t) * term;
        saved = (Number(t) - lo) * term;
      }
      triangle[q][q] = saved;
    }
    for (int k = 0; k <= order; ++k) {
      if (k > p) continue;  // zero
      Number* d = values[k];
      for (int j = 0; j <= p - k; ++j) d[j] = triangle[p - k][j];
      for (int q = p - k + 1; q <= p; ++q) {
        Number before = 0.0;
        for (int r = 0; r < q; ++r) {
          const Number term = d[r] * static_cast<double>(q) / (knot(span + 1 + r) - knot(span + 1 - q + r));
          d[r] = before - term;
          before = term;
        }
        d[q] = before;
      }
    }
  }
};

/// Derivatives of the numerator, relative to the reference, and of the weight.
struct Sums {
  std::array<Triple, jet_size(3)> a;
  std::array<Number, jet_size(3)> w;
  std::array<double, 3> absolute{}, absolute_w{};  ///< the same of absolute values, to first order
};

Sums sum_poles(const BsplineSurface& s, const Vec3& reference, int first_u, int first_v, const Basis& u,
               const Basis& v, int order) {
  Sums out;
  for (int i = 0; i <= s.degree_u; ++i)
    for (int j = 0; j <= s.degree_v; ++j) {
      const std::size_t index = static_cast<std::size_t>(first_u + i) * s.count_v + (first_v + j);
      const double weight = s.weights.empty() ? 1 : s.weights[index];
      const Triple pole = {exact_sum(s.poles[index].x, -reference.x) * weight,
                           exact_sum(s.poles[index].y, -reference.y) * weight,
                           exact_sum(s.poles[index].z, -reference.z) * weight};
      for (int n = 0; n <= order; ++n)
        for (int l = 0; l <= n; ++l) {
          const int m = jet_index(n - l, l);
          const Number basis = u.values[n - l][i] * v.values[l][j];
          for (int c = 0; c < 3; ++c) out.a[m][c] += pole[c] * basis;
          if (!s.weights.empty()) out.w[m] += basis * weight;
          if (m >= 3) continue;
          out.absolute[m] += std::abs(basis.hi) * size(pole);
          if (!s.weights.empty()) out.absolute_w[m] += std::abs(basis.hi) * weight;
        }
    }
  if (s.weights.empty()) out.w[0] = 1.0;
  return out;
}

/// Leibniz for S w = a, solved for the derivatives of S.
void divide(const Sums& sums, int order, std::array<Triple, jet_size(3)>& out) {
  for (int n = 0; n <= order; ++n)
    for (int l = 0; l <= n; ++l) {
      const int k = n - l;
      Triple value = sums.a[jet_index(k, l)];
      for (int i = 0; i <= k; ++i)
        for (int j = i == 0 ? 1 : 0; j <= l; ++j) {
          const Number factor = sums.w[jet_index(i, j)] * (kBinomial[k][i] * kBinomial[l][j]);
          for (int c = 0; c < 3; ++c) value[c] = value[c] - out[jet_index(k - i, l - j)][c] * factor;
        }
      for (int c = 0; c < 3; ++c) out[jet_index(k, l)][c] = value[c] / sums.w[0];
    }
}

}  // namespace

SurfaceJet PreciseJet::rounded() const {
  const auto at = [this](int i) { return dupin::rounded(d[static_cast<std::size_t>(i)]); };
  const auto sum = [this](int c, double origin) { return (d[0][static_cast<std::size_t>(c)] + origin).hi; };
  return {{sum(0, reference.x), sum(1, reference.y), sum(2, reference.z)},
          at(1),
          at(2),
          at(3),
          at(4),
          at(5),
          at(6),
          at(7),
          at(8),
          at(9)};
}

PreciseJet precise_jet(const BsplineSurface& s, double u, double v, int order, Sides sides) {
  const int p = s.degree_u, q = s.degree_v;
  u = into_domain(u, s.knots_u[p], s.knots_u[s.count_u], s.periodic_u, sides.u_from_left);
  v = into_domain(v, s.knots_v[q], s.knots_v[s.count_v], s.periodic_v, sides.v_from_left);
  const int span_u = find_span(s.knots_u, p, u, sides.u_from_left);
  const int span_v = find_span(s.knots_v, q, v, sides.v_from_left);
  const Basis basis_u(s.knots_u, p, span_u, u, order), basis_v(s.knots_v, q, span_v, v, order);
  PreciseJet jet;
  jet.reference = s.poles[static_cast<std::size_t>(span_u - p / 2) * s.count_v + (span_v - q / 2)];
  const Sums sums = sum_poles(s, jet.reference, span_u - p, span_v - q, basis_u, basis_v, order);
  divide(sums, order, jet.d);
  if (order >= 1) {
    const double w = sums.w[0].hi, p0 = size(jet.d[0]);
    jet.size_u = (sums.absolute[1] + p0 * sums.absolute_w[1]) / w;
    jet.size_v = (sums.absolute[2] + p0 * sums.absolute_w[2]) / w;
  }
  return jet;
}

std::optional<Curvature> precise_curvature(const PreciseJet& jet) {
  const Triple &su = jet.d[1], &sv = jet.d[2];
  const Triple normal = cross(su, sv);
  const Number a2 = dot(su, su), area2 = dot(normal, normal);
  const Number a = sqrt(a2), area = sqrt(area2);
  if (!(area.hi > kVanished * jet.size_u * jet.size_v) || !(a.hi > 0)) return {};
  const Number inverse_area = Number(1.0) / area, inverse_a = Number(1.0) / a;
  const Triple n = scaled(normal, inverse_area);
  const Number inverse_d = a * inverse_area, slope = dot(su, sv) * (inverse_a * inverse_a);
  const Number l = dot(jet.d[3], n), m = dot(jet.d[4], n), nn = dot(jet.d[5], n), bent = m - slope * l;
  ShapeOperator s;
  s.n = rounded(n);
  s.e1 = rounded(scaled(su, inverse_a));
  s.e2 = dupin::cross(s.n, s.e1);
  s.w11 = (l * inverse_a * inverse_a).hi;
  s.w12 = (bent * inverse_a * inverse_d).hi;
  s.w22 = ((nn - slope * (m + bent)) * inverse_d * inverse_d).hi;
  const double ia = inverse_a.hi, id = inverse_d.hi;
  const double bound = size(jet.d[3]) * ia * ia + size(jet.d[4]) * ia * id + size(jet.d[5]) * id * id;
  s.noise = 1e-28 * bound * (jet.size_u * ia + jet.size_v * id);
  return diagonalize(s);
}

}  // namespace dupin
