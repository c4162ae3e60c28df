// B-spline and NURBS surfaces: tensor-product sums over the active poles, then the quotient rule.
//
// The sums are formed relative to one of the active poles: derivatives do not change, since the derivatives
// of the basis add up to zero, and nothing is lost to cancellation for a surface far from the origin.
#include "jets.h"
#include "knots.h"

namespace dupin {
namespace {

struct Cell {
  int first_u, first_v;
  const double* basis_u;  // basis_u[k * (degree_u + 1) + i]
  const double* basis_v;
  Vec3 reference;
};

/// Homogeneous derivatives relative to the reference: a = Σ N w (P − reference), w = Σ N w.
/// kOrder >= 0 fixes the order at compile time.
template <int kOrder, bool kRational>
void sum_poles(const BsplineSurface& s, const Cell& cell, int any_order, Vec3* a, double* w) {
  const int order = kOrder >= 0 ? kOrder : any_order;
  constexpr int kTop = kOrder >= 0 ? kOrder : kMaxOrder;
  const int p = s.degree_u, q = s.degree_v;
  Vec3 sum[jet_size(kTop)];
  double sum_w[jet_size(kTop)] = {};
  for (int i = 0; i <= p; ++i) {
    Vec3 row[kTop + 1];
    double row_w[kTop + 1] = {};
    const std::size_t first = static_cast<std::size_t>(cell.first_u + i) * s.count_v + cell.first_v;
    for (int j = 0; j <= q; ++j) {
      const Vec3 offset = s.poles[first + j] - cell.reference;
      const double weight = kRational ? s.weights[first + j] : 1;
      for (int l = 0; l <= order; ++l) {
        const double n = kRational ? cell.basis_v[l * (q + 1) + j] * weight : cell.basis_v[l * (q + 1) + j];
        row[l] += offset * n;
        if constexpr (kRational) row_w[l] += n;
      }
    }
    for (int l = 0; l <= order; ++l)
      for (int k = 0; k + l <= order; ++k) {
        const double n = cell.basis_u[k * (p + 1) + i];
        sum[jet_index(k, l)] += row[l] * n;
        if constexpr (kRational) sum_w[jet_index(k, l)] += row_w[l] * n;
      }
  }
  for (int m = 0; m < jet_size(order); ++m) a[m] = sum[m];
  if constexpr (kRational)
    for (int m = 0; m < jet_size(order); ++m) w[m] = sum_w[m];
}

template <bool kRational>
void sum_poles(const BsplineSurface& s, const Cell& cell, int order, Vec3* a, double* w) {
  switch (order) {
    case 0:
      return sum_poles<0, kRational>(s, cell, order, a, w);
    case 1:
      return sum_poles<1, kRational>(s, cell, order, a, w);
    case 2:
      return sum_poles<2, kRational>(s, cell, order, a, w);
    case 3:
      return sum_poles<3, kRational>(s, cell, order, a, w);
    default:
      return sum_poles<-1, kRational>(s, cell, order, a, w);
  }
}

/// Leibniz for S w = a, solved for the derivatives of S in place of a.
template <int kOrder>
void divide_by_weight(int any_order, Vec3* a, const double* w) {
  const int order = kOrder >= 0 ? kOrder : any_order;
  const double inverse = 1 / w[0];
  for (int n = 0; n <= order; ++n)
    for (int l = 0; l <= n; ++l) {
      const int k = n - l;
      Vec3 value = a[jet_index(k, l)];
      for (int i = 0; i <= k; ++i)
        for (int j = i == 0 ? 1 : 0; j <= l; ++j)
          value -= a[jet_index(k - i, l - j)] * (kBinomial[k][i] * kBinomial[l][j] * w[jet_index(i, j)]);
      a[jet_index(k, l)] = value * inverse;
    }
}

}  // namespace

void evaluate_into(const BsplineSurface& s, double u, double v, int order, Vec3* out, Sides sides) {
  const int p = s.degree_u, q = s.degree_v;
  u = into_domain(u, s.knots_u[p], s.knots_u[s.count_u], s.periodic_u, sides.u_from_left);
  v = into_domain(v, s.knots_v[q], s.knots_v[s.count_v], s.periodic_v, sides.v_from_left);
  const int span_u = find_span(s.knots_u, p, u, sides.u_from_left);
  const int span_v = find_span(s.knots_v, q, v, sides.v_from_left);
  double basis_u[(kMaxOrder + 1) * (kMaxDegree + 1)], basis_v[(kMaxOrder + 1) * (kMaxDegree + 1)];
  basis_derivatives(s.knots_u, p, span_u, u, order, basis_u);
  basis_derivatives(s.knots_v, q, span_v, v, order, basis_v);
  const std::size_t middle = static_cast<std::size_t>(span_u - p / 2) * s.count_v + (span_v - q / 2);
  const Cell cell{span_u - p, span_v - q, basis_u, basis_v, s.poles[middle]};
  if (s.weights.empty()) {
    sum_poles<false>(s, cell, order, out, nullptr);
  } else {
    double w[jet_size(kMaxOrder)] = {};
    sum_poles<true>(s, cell, order, out, w);
    if (order == 2)
      divide_by_weight<2>(order, out, w);
    else
      divide_by_weight<-1>(order, out, w);
  }
  out[0] += cell.reference;
}

}  // namespace dupin
