// Included once for every instruction set by batch_kernels.cpp: the kernels as templates on a vector of lanes
// V.
//
// V has a count, loads and stores, + − × ÷, square roots, comparisons into masks, and choices by them.
#if defined(DUPIN_NURBS_BATCH_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUPIN_NURBS_BATCH_KERNELS_INL_H
#undef DUPIN_NURBS_BATCH_KERNELS_INL_H
#else
#define DUPIN_NURBS_BATCH_KERNELS_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include <hwy/highway.h>
#include "batch_kernels.h"
#include "knots.h"

HWY_BEFORE_NAMESPACE();
namespace dupin::kernels {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// For lambdas: compiled for the instruction set at hand, within the function that calls them.
#undef DUPIN_LANES
#define DUPIN_LANES HWY_ATTR __attribute__((always_inline))

struct Lanes {
  using D = hn::ScalableTag<double>;
  using Mask = hn::Mask<D>;
  static constexpr std::size_t kCount = hn::MaxLanes(D());
  hn::Vec<D> v;

  static HWY_INLINE Lanes load(const double* p) { return {hn::LoadU(D(), p)}; }
  static HWY_INLINE Lanes all(double x) { return {hn::Set(D(), x)}; }
  HWY_INLINE void store(double* p) const { hn::StoreU(v, D(), p); }
};
HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
  return {hn::Add(a.v, b.v)};
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
  return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
  return {hn::Mul(a.v, b.v)};
}
HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
  return {hn::Div(a.v, b.v)};
}
HWY_INLINE Lanes root(Lanes a) {
  return {hn::Sqrt(a.v)};
}
HWY_INLINE Lanes absolute(Lanes a) {
  return {hn::Abs(a.v)};
}
HWY_INLINE Lanes::Mask less_equal(Lanes a, Lanes b) {
  return hn::Le(a.v, b.v);
}
HWY_INLINE Lanes::Mask both(Lanes::Mask a, Lanes::Mask b) {
  return hn::And(a, b);
}
HWY_INLINE Lanes choose(Lanes::Mask m, Lanes yes, Lanes no) {
  return {hn::IfThenElse(m, yes.v, no.v)};
}
HWY_INLINE unsigned bits(Lanes::Mask m) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Lanes::D(), m, bytes);
  return bytes[0];
}

/// The scalar twin's one lane.
struct Single {
  using Mask = bool;
  static constexpr std::size_t kCount = 1;
  double v;

  static Single load(const double* p) { return {*p}; }
  static Single all(double x) { return {x}; }
  void store(double* p) const { *p = v; }
};
inline Single operator+(Single a, Single b) {
  return {a.v + b.v};
}
inline Single operator-(Single a, Single b) {
  return {a.v - b.v};
}
inline Single operator*(Single a, Single b) {
  return {a.v * b.v};
}
inline Single operator/(Single a, Single b) {
  return {a.v / b.v};
}
inline Single root(Single a) {
  return {std::sqrt(a.v)};
}
inline Single absolute(Single a) {
  return {std::abs(a.v)};
}
inline bool less_equal(Single a, Single b) {
  return a.v <= b.v;
}
inline bool both(bool a, bool b) {
  return a && b;
}
inline Single choose(bool m, Single yes, Single no) {
  return m ? yes : no;
}
inline unsigned bits(bool m) {
  return m ? 1u : 0u;
}

template <class V>
struct Triple {
  V x, y, z;
};
template <class V>
HWY_INLINE Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
HWY_INLINE Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
HWY_INLINE Triple<V> operator*(const Triple<V>& a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class V>
HWY_INLINE V inner(const Triple<V>& a, const Triple<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
HWY_INLINE Triple<V> outer(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
HWY_INLINE Triple<V> everywhere(const Vec3& p) {
  return {V::all(p.x), V::all(p.y), V::all(p.z)};
}
template <class V>
HWY_INLINE V larger(V a, V b) {
  return choose(less_equal(a, b), b, a);
}

template <class V>
HWY_INLINE void put(V value, int channel, const Outputs& out, std::size_t n) {
  if (out.at[channel]) value.store(out.at[channel] + n);
}
template <class V>
HWY_INLINE void put(const Triple<V>& value, int channel, const Outputs& out, std::size_t n) {
  if (!out.at[channel]) return;
  value.x.store(out.at[channel] + n);
  value.y.store(out.at[channel + 1] + n);
  value.z.store(out.at[channel + 2] + n);
}

/// The best projection of the x, y, z axes onto the tangent plane, as in principal_curvature.
template <class V>
HWY_INLINE Triple<V> projected_axis(const Triple<V>& n) {
  const V slack = V::all(1e-12), one = V::all(1), none = V::all(0);
  const V x = absolute(n.x), y = absolute(n.y), z = absolute(n.z);
  const auto keep_x = less_equal(x - slack, y);
  const V best = choose(keep_x, x, y), component = choose(keep_x, n.x, n.y);
  const auto keep_best = less_equal(best - slack, z);
  const V along = choose(keep_best, component, n.z);
  const Triple<V> axis{choose(keep_best, choose(keep_x, one, none), none),
                       choose(keep_best, choose(keep_x, none, one), none), choose(keep_best, none, one)};
  const Triple<V> d = axis - n * along;
  return d * (one / root(inner(d, d)));
}

template <class V>
HWY_INLINE void put_kinds(typename V::Mask umbilic, typename V::Mask safe, const Outputs& out,
                          std::size_t n) {
  if (!out.kind) return;
  std::memset(out.kind + n, static_cast<int>(Curvature::Kind::regular), V::kCount);
  const unsigned equal = bits(umbilic), good = bits(safe), every = (1u << V::kCount) - 1;
  if (HWY_LIKELY(equal == 0 && good == every)) return;
  for (std::size_t i = 0; i < V::kCount; ++i) {
    if (equal >> i & 1) out.kind[n + i] = static_cast<std::uint8_t>(Curvature::Kind::umbilic);
    if (!(good >> i & 1)) out.kind[n + i] = kCareful;
  }
}

// Of a rational surface S = A/w everything up to curvatures is computed from w² Su = w Au − A wu, w² Sv, and
// w² (n·Suu) = n·(w Auu − A wuu) and so on (along the normal Su and Sv vanish, and with them the rest of the
// quotient rule): no division stands before the cross product. The shape operator is w² times what these
// give.
//
// With a = |Su| and d = |Su × Sv| / a, it needs 1/a², 1/(ad) and 1/d² alone, and the first direction one more
// root: lengths are left squared where they can be.

/// First derivatives (times w²) and normal, and what the second form needs of them.
template <class V>
struct Tangents {
  Triple<V> pu, n;
  V a2, dots;
  V inverse_aa, inverse_ad, inverse_dd;
  V loss2;  // squared: how many times the rounding of the derivatives, as a part of them, turns the normal
  typename V::Mask safe;
};

/// |Su × Sv| below this part of |Su||Sv|, squared, is left to the careful.
inline constexpr double kParallelSquared = 1e-6;
/// Largest loss for a normal.
inline constexpr double kNormalLoss = 1e6;
/// Largest product of what rounding may add to the shape operator and the larger curvature's size.
inline constexpr double kCurvatureLoss = 2.5e5;

template <class V>
HWY_INLINE Tangents<V> tangents(const Triple<V>& pu, const Triple<V>& pv, V w2, const CellScale& scale) {
  Tangents<V> t;
  const Triple<V> normal = outer(pu, pv);
  const V area2 = inner(normal, normal), b2 = inner(pv, pv);
  t.pu = pu;
  t.a2 = inner(pu, pu);
  t.dots = inner(pu, pv);
  const V area = root(area2), inverse = V::all(1) / (area * t.a2);
  t.inverse_ad = t.a2 * inverse;
  t.inverse_aa = area * inverse;
  t.inverse_dd = t.a2 * t.inverse_ad * t.inverse_ad;
  t.n = normal * t.inverse_ad;
  t.loss2 = (V::all(scale.size[1] * scale.size[1]) * t.inverse_aa +
             V::all(scale.size[2] * scale.size[2]) * t.inverse_dd) *
            (w2 * w2);
  t.safe = both(less_equal(V::all(kParallelSquared) * t.a2 * b2, area2),
                less_equal(t.loss2, V::all(kNormalLoss * kNormalLoss)));
  return t;
}

/// From w² times the second derivatives' parts that count along the normal.
template <class V>
HWY_INLINE void curvatures(const Tangents<V>& t, const Triple<V>& uu, const Triple<V>& uv,
                           const Triple<V>& vv, V w2, const CellScale& scale, const Outputs& out,
                           std::size_t n) {
  const V half = V::all(0.5), none = V::all(0);
  const V slope = t.dots * t.inverse_aa;
  const V l = inner(uu, t.n), m = inner(uv, t.n), nn = inner(vv, t.n);
  const V bent = m - slope * l;
  const V w11 = l * t.inverse_aa, w12 = bent * t.inverse_ad, w22 = (nn - slope * (m + bent)) * t.inverse_dd;
  const V mean = half * (w11 + w22), apart = half * (w11 - w22), r = root(apart * apart + w12 * w12);
  const V gauss = w11 * w22 - w12 * w12;
  const auto positive = less_equal(none, mean);
  const V k1 = choose(positive, mean + r, mean - r);

  const V noise = (V::all(scale.size[3]) * t.inverse_aa + V::all(scale.size[4]) * t.inverse_ad +
                   V::all(scale.size[5]) * t.inverse_dd) *
                  w2;
  const V size = V::all(kCurvatureLoss) * larger(w2 * absolute(k1), V::all(scale.least_curvature));
  const auto safe = both(t.safe, less_equal(noise * noise * t.loss2 * (w2 * w2), size * size));
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const auto umbilic = less_equal(r, V::all(1e-12) * absolute(mean) + V::all(kEpsilon) * noise);
  const bool any_umbilic = bits(umbilic) != 0;
  if (out.at[kDirection1]) {
    // The eigenvector (x, y) of the larger curvature, of which neither component cancels.
    const V signed_w12 = choose(positive, w12, none - w12), along = choose(positive, apart, none - apart);
    const auto forward = less_equal(none, along);
    const V x = choose(forward, r + along, signed_w12), y = choose(forward, signed_w12, r - along);
    const V inverse_norm = V::all(1) / root(t.a2 * (x * x + y * y));
    Triple<V> d1 = t.pu * (x * inverse_norm) + outer(t.n, t.pu) * (y * inverse_norm);
    if (HWY_UNLIKELY(any_umbilic)) {
      const Triple<V> axis = projected_axis(t.n);
      d1 = {choose(umbilic, axis.x, d1.x), choose(umbilic, axis.y, d1.y), choose(umbilic, axis.z, d1.z)};
    }
    put(d1, kDirection1, out, n);
    if (out.at[kDirection2]) put(outer(t.n, d1), kDirection2, out, n);
  }
  if (out.at[kK1]) {
    V larger_one = k1, smaller_one = gauss / k1;
    if (HWY_UNLIKELY(any_umbilic)) {
      larger_one = choose(umbilic, mean, larger_one);
      smaller_one = choose(umbilic, mean, smaller_one);
    }
    put(larger_one * w2, kK1, out, n);
    put(smaller_one * w2, kK2, out, n);
  }
  put(mean * w2, kMean, out, n);
  put(gauss * (w2 * w2), kGauss, out, n);
  put_kinds<V>(umbilic, safe, out, n);
}

/// The derivatives of numerator and weight, h[jet · kComponents + c].
template <class V, int kComponents>
struct Homogeneous {
  const V* h;
  HWY_INLINE Triple<V> a(int m) const {
    return {h[m * kComponents], h[m * kComponents + 1], h[m * kComponents + 2]};
  }
  HWY_INLINE V w(int m) const { return kComponents == 4 ? h[m * kComponents + kComponents - 1] : V::all(0); }
  /// w A_m − A w_m, or A_m without weights.
  HWY_INLINE Triple<V> reduced(int m) const { return kComponents == 4 ? a(m) * w(0) - a(0) * w(m) : a(m); }
};

template <class V, int kComponents>
HWY_INLINE void put_third(const Homogeneous<V, kComponents>& h, const Triple<V>& p, const Triple<V>& pu,
                          const Triple<V>& pv, const Triple<V>& uu, const Triple<V>& uv, const Triple<V>& vv,
                          V inverse, const Outputs& out, std::size_t n) {
  Triple<V> d[4] = {h.a(6), h.a(7), h.a(8), h.a(9)};
  if constexpr (kComponents == 4) {
    const V two = V::all(2), three = V::all(3);
    d[0] = d[0] - p * h.w(6) - pu * (three * h.w(3)) - uu * (three * h.w(1));
    d[1] = d[1] - p * h.w(7) - pu * (two * h.w(4)) - pv * h.w(3) - uu * h.w(2) - uv * (two * h.w(1));
    d[2] = d[2] - p * h.w(8) - pv * (two * h.w(4)) - pu * h.w(5) - vv * h.w(1) - uv * (two * h.w(2));
    d[3] = d[3] - p * h.w(9) - pv * (three * h.w(5)) - vv * (three * h.w(2));
    for (Triple<V>& each : d) each = each * inverse;
  }
  for (int i = 0; i < 4; ++i) put(d[i], kJet + 18 + 3 * i, out, n);
}

/// From the derivatives of numerator and weight to all that is wanted.
template <class V, int kComponents, int kOrder>
HWY_INLINE void finish(const Cell& cell, const Wanted& wanted, const V* values, const Outputs& out,
                       std::size_t n) {
  constexpr bool kRational = kComponents == 4;
  const Homogeneous<V, kComponents> h{values};
  V inverse = V::all(1), w2 = V::all(1);
  Triple<V> p = h.a(0);
  if constexpr (kRational) inverse = V::all(1) / h.w(0), w2 = h.w(0) * h.w(0), p = p * inverse;
  put(everywhere<V>(cell.reference) + p, kJet, out, n);
  if constexpr (kOrder >= 1) {
    Triple<V> pu = h.reduced(1), pv = h.reduced(2);
    if (wanted.normal || wanted.curvature) {
      const Tangents<V> t = tangents(pu, pv, w2, cell.scale);
      put(t.n, kNormal, out, n);
      if constexpr (kOrder >= 2)
        if (wanted.curvature) curvatures(t, h.reduced(3), h.reduced(4), h.reduced(5), w2, cell.scale, out, n);
      if (!wanted.curvature) put_kinds<V>(less_equal(V::all(1), V::all(0)), t.safe, out, n);
    }
    if (!out.at[kJet + 3] && !out.at[kJet + 9] && !out.at[kJet + 18]) return;
    if constexpr (kRational) pu = pu * (inverse * inverse), pv = pv * (inverse * inverse);
    put(pu, kJet + 3, out, n);
    put(pv, kJet + 6, out, n);
    if constexpr (kOrder >= 2) {
      Triple<V> uu = h.a(3), uv = h.a(4), vv = h.a(5);
      if constexpr (kRational) {
        const V two = V::all(2);
        uu = (uu - p * h.w(3) - pu * (two * h.w(1))) * inverse;
        uv = (uv - p * h.w(4) - pu * h.w(2) - pv * h.w(1)) * inverse;
        vv = (vv - p * h.w(5) - pv * (two * h.w(2))) * inverse;
      }
      put(uu, kJet + 9, out, n);
      put(uv, kJet + 12, out, n);
      put(vv, kJet + 15, out, n);
      if constexpr (kOrder >= 3) put_third(h, p, pu, pv, uu, uv, vv, inverse, out, n);
    }
  }
}

/// One step of the recurrence of Bernstein polynomials, whose sums are all of positive terms: from degree q
/// to q + 1.
template <class V>
HWY_INLINE void raise_bernstein(V s, V r, int q, V* current) {
  current[q + 1] = current[q] * s;
  for (int i = q; i > 0; --i) current[i] = current[i] * r + current[i - 1] * s;
  current[0] = current[0] * r;
}

/// Rows as basis_row says, from degree kQ on; all known when compiling.
template <class V, int kDegree, int kOrder, int kQ>
HWY_INLINE void bernstein_steps(V s, V r, V* current, V* rows) {
  if constexpr (kQ + kOrder >= kDegree)
    for (int i = 0; i <= kQ; ++i) rows[basis_row(kDegree, kDegree - kQ, i)] = current[i];
  if constexpr (kQ < kDegree) {
    raise_bernstein(s, r, kQ, current);
    bernstein_steps<V, kDegree, kOrder, kQ + 1>(s, r, current, rows);
  }
}

/// The same; kDegree 0: not known.
template <class V, int kDegree>
HWY_INLINE void bernstein_rows(V s, V r, int degree, int order, V* rows) {
  V current[kMaxDegree + 1];
  current[0] = V::all(1);
  if constexpr (kDegree > 0) return bernstein_steps<V, kDegree, 2, 0>(s, r, current, rows);
  const int least = degree - std::min(order, degree);
  for (int q = 0;; ++q) {
    if (q >= least)
      for (int i = 0; i <= q; ++i) rows[basis_row(degree, degree - q, i)] = current[i];
    if (q == degree) return;
    raise_bernstein(s, r, q, current);
  }
}

/// s and 1 − s, the smaller of them computed first.
template <class V>
HWY_INLINE void local_parameter(V t, const LocalRange& range, V* s, V* r) {
  const V left = t - V::all(range.lo), right = V::all(range.hi) - t;
  const auto first = less_equal(left, right);
  const V x = choose(first, left, right) / V::all(range.hi - range.lo), y = V::all(1) - x;
  *s = choose(first, x, y);
  *r = choose(first, y, x);
}

template <class V>
void basis_block(const BasisJob& job, const double* t, std::size_t n) {
  V s, r, rows[4 * (kMaxDegree + 1)];
  local_parameter(V::load(t), job.range, &s, &r);
  bernstein_rows<V, 0>(s, r, job.degree, job.order, rows);
  const int count = basis_rows(job.degree, std::min(job.order, job.degree));
  for (int i = 0; i < count; ++i) rows[i].store(job.values + static_cast<std::size_t>(i) * job.stride + n);
}

/// A net summed over u: `width` numbers, in steps of two blocks of lanes. kDegree −1: not known here.
template <class V, int kDegree>
HWY_INLINE void sum_rows(const double* poles, std::size_t width, int degree_u, const double* values,
                         double* to) {
  const int degree = kDegree >= 0 ? kDegree : degree_u;
  for (double* const end = to + width; to < end; to += 2 * V::kCount, poles += 2 * V::kCount) {
    V first = V::all(values[0]) * V::load(poles), second = V::all(values[0]) * V::load(poles + V::kCount);
    const double* pole = poles + width;
    for (int i = 1; i <= degree; ++i, pole += width) {
      first = first + V::all(values[i]) * V::load(pole);
      second = second + V::all(values[i]) * V::load(pole + V::kCount);
    }
    first.store(to);
    second.store(to + V::kCount);
  }
}

/// The row's numerator and weight as polynomials in v: each net summed over u.
template <class V, int kComponents, int kOrder>
HWY_INLINE void contract_u(const RowJob& job, double* rows, std::array<const double*, 10>& at) {
  const NetLayout& layout = *job.cell->layout;
  for (int b = 0; b <= kOrder; ++b)
    for (int a = 0; a + b <= kOrder; ++a) {
      const Net& net = layout.nets[jet_index(a, b)];
      at[jet_index(a, b)] = net.zero ? nullptr : rows;
      if (net.zero) continue;
      const std::size_t width = static_cast<std::size_t>((net.degree_v + 1) * kComponents);
      const double *poles = job.cell->poles + net.offset,
                   *values = job.basis_u + basis_row(layout.degree_u, a, 0);
      switch (net.degree_u) {
        case 1:
          sum_rows<V, 1>(poles, width, 1, values, rows);
          break;
        case 2:
          sum_rows<V, 2>(poles, width, 2, values, rows);
          break;
        case 3:
          sum_rows<V, 3>(poles, width, 3, values, rows);
          break;
        default:
          sum_rows<V, -1>(poles, width, net.degree_u, values, rows);
      }
      rows += width;
    }
}

/// One derivative of a block: the row's net summed over v. kDegree 0: not known here.
template <class V, int kDegree, int kComponents, int kB>
HWY_INLINE void sum_v(const double* row, const double* values, std::size_t stride, int degree_v, V* h) {
  const int degree = kDegree > 0 ? kDegree - kB : degree_v - kB;
  if (degree < 0 || !row) {
    for (int c = 0; c < kComponents; ++c) h[c] = V::all(0);
    return;
  }
  V s[kComponents];
  const V first = V::load(values);
  for (int c = 0; c < kComponents; ++c) s[c] = first * V::all(row[c]);
  for (int j = 1; j <= degree; ++j) {
    const V value = V::load(values + static_cast<std::size_t>(j) * stride);
    for (int c = 0; c < kComponents; ++c) s[c] = s[c] + value * V::all(row[j * kComponents + c]);
  }
  for (int c = 0; c < kComponents; ++c) h[c] = s[c];
}

template <class V, int kDegree, int kComponents, int kOrder, int kB>
HWY_INLINE void sum_level(const RowJob& job, const std::array<const double*, 10>& at, std::size_t n, V* h) {
  if constexpr (kB <= kOrder) {
    const int degree = kDegree > 0 ? kDegree : job.cell->layout->degree_v;
    const double* values = job.basis_v + static_cast<std::size_t>(basis_row(degree, kB, 0)) * job.stride + n;
    const auto sum = [&](int a) DUPIN_LANES {
      const int m = jet_index(a, kB);
      sum_v<V, kDegree, kComponents, kB>(at[m], values, job.stride, degree, h + m * kComponents);
    };
    sum(0);
    if constexpr (kB + 1 <= kOrder) sum(1);
    if constexpr (kB + 2 <= kOrder) sum(2);
    if constexpr (kB + 3 <= kOrder) sum(3);
  }
}

template <class V, int kDegree, int kComponents, int kOrder>
HWY_INLINE void row_block(const RowJob& job, const std::array<const double*, 10>& at, std::size_t n,
                          const Outputs& out, std::size_t to) {
  V h[jet_size(kOrder) * kComponents];
  sum_level<V, kDegree, kComponents, kOrder, 0>(job, at, n, h);
  sum_level<V, kDegree, kComponents, kOrder, 1>(job, at, n, h);
  sum_level<V, kDegree, kComponents, kOrder, 2>(job, at, n, h);
  sum_level<V, kDegree, kComponents, kOrder, 3>(job, at, n, h);
  finish<V, kComponents, kOrder>(*job.cell, job.wanted, h, out, to);
}

/// Results of a block that is not full, to be copied from.
template <class V>
struct Spare {
  double values[kChannels][V::kCount];
  std::uint8_t kinds[V::kCount];
  Outputs outputs(const Outputs& like) {
    Outputs out;
    for (int c = 0; c < kChannels; ++c) out.at[c] = like.at[c] ? values[c] : nullptr;
    out.kind = like.kind ? kinds : nullptr;
    return out;
  }
  void copy(std::size_t count, const Outputs& to, std::size_t first) const {
    for (int c = 0; c < kChannels; ++c)
      if (to.at[c]) std::copy_n(values[c], count, to.at[c] + first);
    if (to.kind) std::copy_n(kinds, count, to.kind + first);
  }
};

/// block(n, outputs, to) for every block of lanes; the last one of a row overlaps the one before.
template <class V, class Block>
HWY_INLINE void in_blocks(std::size_t count, const Outputs& out, std::size_t first, const Block& block) {
  constexpr std::size_t kCount = V::kCount;
  Spare<V> spare;
  alignas(Outputs) unsigned char memory[sizeof(Outputs)];  // not initialised where it is not needed
  const Outputs* to = &out;
  const bool few = count < kCount;
  if (HWY_UNLIKELY(few)) to = new (memory) Outputs(spare.outputs(out));
  const std::size_t last = few ? 0 : count - kCount, offset = few ? 0 : first;
  for (std::size_t n = 0;; n = std::min(n + kCount, last)) {
    block(n, *to, offset + n);
    if (n == last) break;
  }
  if (few) spare.copy(count, out, first);
}

template <class V, int kDegree, int kComponents, int kOrder>
void row_of_degree(const RowJob& job) {
  double rows[10 * (kMaxDegree + 1) * 4 + kPadding];
  std::array<const double*, 10> at;
  contract_u<V, kComponents, kOrder>(job, rows, at);
  in_blocks<V>(job.count, *job.out, job.first,
               [&](std::size_t n, const Outputs& out, std::size_t to)
                   DUPIN_LANES { row_block<V, kDegree, kComponents, kOrder>(job, at, n, out, to); });
}

/// Loops are unrolled where second derivatives are wanted of a usual degree.
template <class V, int kComponents>
void row_of_components(const RowJob& job) {
  if (job.wanted.order == 0) return row_of_degree<V, 0, kComponents, 0>(job);
  if (job.wanted.order == 1) return row_of_degree<V, 0, kComponents, 1>(job);
  if (job.wanted.order == 3) return row_of_degree<V, 0, kComponents, 3>(job);
  switch (job.cell->layout->degree_v) {
    case 1:
      return row_of_degree<V, 1, kComponents, 2>(job);
    case 2:
      return row_of_degree<V, 2, kComponents, 2>(job);
    case 3:
      return row_of_degree<V, 3, kComponents, 2>(job);
    case 4:
      return row_of_degree<V, 4, kComponents, 2>(job);
    case 5:
      return row_of_degree<V, 5, kComponents, 2>(job);
    default:
      return row_of_degree<V, 0, kComponents, 2>(job);
  }
}

/// The same sums as a row's, in the same order, with values of u that differ from lane to lane. Degrees −1:
/// not known when compiling.
template <class V, int kComponents, int kDegreeU, int kDegreeV>
HWY_INLINE void sum_net(const Net& net, const double* poles, const V* u, const V* v, V* h) {
  const int degree_u = kDegreeU >= 0 ? kDegreeU : net.degree_u,
            degree_v = kDegreeV >= 0 ? kDegreeV : net.degree_v;
  const int width = (degree_v + 1) * kComponents;
  const auto column = [&](int j, V* s) DUPIN_LANES {
    const double* pole = poles + j * kComponents;
    for (int c = 0; c < kComponents; ++c) s[c] = u[0] * V::all(pole[c]);
    for (int i = 1; i <= degree_u; ++i)
      for (int c = 0; c < kComponents; ++c) s[c] = s[c] + u[i] * V::all(pole[i * width + c]);
  };
  V total[kComponents], s[kComponents];
  column(0, s);
  for (int c = 0; c < kComponents; ++c) total[c] = v[0] * s[c];
  for (int j = 1; j <= degree_v; ++j) {
    column(j, s);
    for (int c = 0; c < kComponents; ++c) total[c] = total[c] + v[j] * s[c];
  }
  for (int c = 0; c < kComponents; ++c) h[c] = total[c];
}

/// Derivatives (kA, kB), of a net of known degree if kDegree, both ways, is.
template <class V, int kComponents, int kDegree, int kA, int kB>
HWY_INLINE void sum_derivative(const PointsJob& job, const V* basis_u, const V* basis_v, V* h) {
  const NetLayout& layout = *job.cell->layout;
  const Net& net = layout.nets[jet_index(kA, kB)];
  V* sum = h + jet_index(kA, kB) * kComponents;
  constexpr bool kZero = kDegree > 0 && (kA > kDegree || kB > kDegree);
  if (kZero || net.zero) {
    for (int c = 0; c < kComponents; ++c) sum[c] = V::all(0);
    return;
  }
  constexpr int kU = kDegree > 0 && !kZero ? kDegree - kA : -1,
                kV = kDegree > 0 && !kZero ? kDegree - kB : -1;
  sum_net<V, kComponents, kU, kV>(net, job.cell->poles + net.offset,
                                  basis_u + basis_row(layout.degree_u, kA, 0),
                                  basis_v + basis_row(layout.degree_v, kB, 0), sum);
}

template <class V, int kComponents, int kOrder, int kDegree>
HWY_INLINE void points_block(const PointsJob& job, const double* u, const double* v, const Outputs& out,
                             std::size_t to) {
  constexpr int kRows = kDegree > 0 ? basis_rows(kDegree, std::min(kOrder, kDegree)) : 4 * (kMaxDegree + 1);
  V s, r, bu[kRows], bv[kRows], h[jet_size(kOrder) * kComponents];
  local_parameter(V::load(u), job.range_u, &s, &r);
  bernstein_rows<V, kDegree>(s, r, job.cell->layout->degree_u, kOrder, bu);
  local_parameter(V::load(v), job.range_v, &s, &r);
  bernstein_rows<V, kDegree>(s, r, job.cell->layout->degree_v, kOrder, bv);
  sum_derivative<V, kComponents, kDegree, 0, 0>(job, bu, bv, h);
  if constexpr (kOrder >= 1) {
    sum_derivative<V, kComponents, kDegree, 1, 0>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 0, 1>(job, bu, bv, h);
  }
  if constexpr (kOrder >= 2) {
    sum_derivative<V, kComponents, kDegree, 2, 0>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 1, 1>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 0, 2>(job, bu, bv, h);
  }
  if constexpr (kOrder >= 3) {
    sum_derivative<V, kComponents, kDegree, 3, 0>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 2, 1>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 1, 2>(job, bu, bv, h);
    sum_derivative<V, kComponents, kDegree, 0, 3>(job, bu, bv, h);
  }
  finish<V, kComponents, kOrder>(*job.cell, job.wanted, h, out, to);
}

template <class V, int kComponents, int kOrder, int kDegree>
void points_of_degree(const PointsJob& job) {
  double u[V::kCount], v[V::kCount];
  const bool few = job.count < V::kCount;
  for (std::size_t i = 0; few && i < V::kCount; ++i)
    u[i] = job.u[std::min(i, job.count - 1)], v[i] = job.v[std::min(i, job.count - 1)];
  in_blocks<V>(
      job.count, *job.out, job.first, [&](std::size_t n, const Outputs& out, std::size_t to) DUPIN_LANES {
        points_block<V, kComponents, kOrder, kDegree>(job, few ? u : job.u + n, few ? v : job.v + n, out, to);
      });
}

template <class V, int kComponents>
void points_of_components(const PointsJob& job) {
  if (job.wanted.order == 0) return points_of_degree<V, kComponents, 0, 0>(job);
  if (job.wanted.order == 1) return points_of_degree<V, kComponents, 1, 0>(job);
  if (job.wanted.order == 3) return points_of_degree<V, kComponents, 3, 0>(job);
  const NetLayout& layout = *job.cell->layout;
  switch (layout.degree_u == layout.degree_v ? layout.degree_u : 0) {
    case 1:
      return points_of_degree<V, kComponents, 2, 1>(job);
    case 2:
      return points_of_degree<V, kComponents, 2, 2>(job);
    case 3:
      return points_of_degree<V, kComponents, 2, 3>(job);
    case 4:
      return points_of_degree<V, kComponents, 2, 4>(job);
    case 5:
      return points_of_degree<V, kComponents, 2, 5>(job);
    default:
      return points_of_degree<V, kComponents, 2, 0>(job);
  }
}

/// Components along the turning axes, or those of space, turned or as they are.
template <class V>
struct Turn {
  Triple<V> radial, around, z;
  HWY_INLINE Triple<V> operator()(V x, V y, V along) const { return radial * x + around * y + z * along; }
};

template <class V>
HWY_INLINE Turn<V> turn_at(const SweptJob& job, std::size_t n) {
  const Triple<V> x = everywhere<V>(job.x), y = everywhere<V>(job.y), z = everywhere<V>(job.z);
  if (!job.turned) return {x, y, z};
  const std::size_t at = n * job.sweep_stride;
  const V c = job.sweep_stride ? V::load(job.cosine + at) : V::all(*job.cosine);
  const V s = job.sweep_stride ? V::load(job.sine + at) : V::all(*job.sine);
  return {x * c + y * s, y * c - x * s, z};
}

template <class V>
HWY_INLINE void swept_frame(const SweptJob& job, const Turn<V>& turn, std::size_t n, const Outputs& out,
                            std::size_t to) {
  const auto get = [&](const double* values)
                       DUPIN_LANES { return job.profile_stride ? V::load(values + n) : V::all(*values); };
  const auto vector = [&](int i) DUPIN_LANES {
    return turn(get(job.frame[i]), get(job.frame[i + 1]), get(job.frame[i + 2]));
  };
  const Triple<V> normal = vector(0);
  put(normal, kNormal, out, to);
  if (out.kind)
    for (std::size_t i = 0; i < V::kCount; ++i)
      out.kind[to + i] = job.profile_stride ? job.kind[n + i] : *job.kind;
  if (!job.wanted.curvature) return;
  if (out.at[kDirection1]) {
    Triple<V> d1 = vector(3), d2 = vector(6);
    const auto umbilic = less_equal(inner(d1, d1), V::all(0));
    if (bits(umbilic) != 0) {
      const Triple<V> axis = projected_axis(normal), other = outer(normal, axis);
      d1 = {choose(umbilic, axis.x, d1.x), choose(umbilic, axis.y, d1.y), choose(umbilic, axis.z, d1.z)};
      d2 = {choose(umbilic, other.x, d2.x), choose(umbilic, other.y, d2.y), choose(umbilic, other.z, d2.z)};
    }
    put(d1, kDirection1, out, to);
    put(d2, kDirection2, out, to);
  }
  const V k1 = get(job.k[0]), k2 = get(job.k[1]);
  put(k1, kK1, out, to);
  put(k2, kK2, out, to);
  put((k1 + k2) * V::all(0.5), kMean, out, to);
  put(k1 * k2, kGauss, out, to);
}

template <class V>
HWY_INLINE void swept_block(const SweptJob& job, std::size_t n, const Outputs& out, std::size_t to) {
  const auto get = [&](int i) DUPIN_LANES {
    return job.profile_stride ? V::load(job.profile[i] + n) : V::all(*job.profile[i]);
  };
  const Turn<V> turn = turn_at<V>(job, n);
  const Triple<V> direction = everywhere<V>(job.direction), none = everywhere<V>({});
  for (int k = 0; k <= job.wanted.order; ++k)
    for (int l = 0; l <= k; ++l) {
      const int i = k - l, m = jet_index(i, l);
      if (!out.at[kJet + 3 * m]) continue;
      Triple<V> d = none;
      if (job.turned) {
        // Each derivative by the angle turns (x, y) by a right angle and drops what is along the axis.
        V x = get(3 * l), y = get(3 * l + 1), z = i == 0 ? get(3 * l + 2) : V::all(0);
        for (int t = 0; t < i; ++t) {
          const V before = x;
          x = V::all(0) - y;
          y = before;
        }
        d = turn(x, y, z);
      } else if (l == 0) {
        d = turn(get(3 * i), get(3 * i + 1), get(3 * i + 2));
        if (i == 0) {
          const V along = job.sweep_stride ? V::load(job.length + n) : V::all(*job.length);
          d = d + direction * along;
        }
      } else if (l == 1 && i == 0) {
        d = direction;
      }
      if (m == 0) d = everywhere<V>(job.origin) + d;
      put(d, kJet + 3 * m, out, to);
    }
  if (job.wanted.normal || job.wanted.curvature) swept_frame(job, turn, n, out, to);
}

template <class V>
void swept_of(const SweptJob& job) {
  in_blocks<V>(job.count, *job.out, job.first,
               [&](std::size_t n, const Outputs& out, std::size_t to)
                   DUPIN_LANES { swept_block<V>(job, n, out, to); });
}

template <class V>
void basis_of(const BasisJob& job) {
  std::size_t n = 0;
  for (; n + V::kCount <= job.count; n += V::kCount) basis_block<V>(job, job.t + n, n);
  for (; n < job.count; ++n) basis_block<Single>(job, job.t + n, n);
}
template <class V>
void row_of(const RowJob& job) {
  return job.cell->layout->components == 4 ? row_of_components<V, 4>(job) : row_of_components<V, 3>(job);
}
template <class V>
void points_of(const PointsJob& job) {
  return job.cell->layout->components == 4 ? points_of_components<V, 4>(job)
                                           : points_of_components<V, 3>(job);
}

}  // namespace HWY_NAMESPACE
}  // namespace dupin::kernels
HWY_AFTER_NAMESPACE();

#endif
