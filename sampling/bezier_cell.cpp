// See docs/mathematics.md, "Certificates". F∘S is a polynomial of twice the patch's degrees (over w² for
// rational ones); its Bernstein coefficients bound |F| over the cell and, through its derivatives and the
// chart's Jacobian, the difference between the slopes of quadric and surface as graphs over the DP's tangent
// plane. The angle between two normals is at most the difference of their graphs' slopes.
#include "bezier_cell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "small_solve.h"

namespace dupin {
namespace {

using bernstein::Net;
using bernstein::Range;
using bernstein::Side;

/// ∂F/∂z stays above this over an accepted cell (1 at its centre).
constexpr double kLeastSheet = 0.3;
/// What a, b, c may take of that 1, so that the sheet's end stays well away.
constexpr double kMostSteep = 0.5;
/// The chart's Jacobian changes by at most this much, relative, over an accepted cell: then (s,t) ↦ (x,y) is
/// one to one.
constexpr double kMostTwist = 0.5;

Vec4 operator+(const Vec4& a, const Vec4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
Vec4 operator-(const Vec4& a, const Vec4& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
Vec4 operator*(const Vec4& a, double s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}
Vec3 xyz(const Vec4& a) {
  return {a.x, a.y, a.z};
}
Vec3 dehomogenised(const Vec4& a) {
  return xyz(a) / a.w;
}

/// Value, first and second derivative at ½ of a Bézier polynomial that was reduced to its last `count` <= 3
/// points.
struct Middle {
  Vec4 value, first, second;
};
Middle middle(const Vec4* b, int count, int degree) {
  if (count == 1) return {b[0], {}, {}};
  if (count == 2) return {(b[0] + b[1]) * 0.5, b[1] - b[0], {}};
  return {(b[0] + b[1] * 2 + b[2]) * 0.25, (b[2] - b[0]) * (0.5 * degree),
          (b[0] - b[1] * 2 + b[2]) * (static_cast<double>(degree) * (degree - 1))};
}

/// g x = r (r in the last column; the lower triangle of g is enough), by Cholesky with a ridge relative to
/// each one's own size.
void solve_cubic(const double g[4][5], double x[4]) {
  double l[4][4] = {}, y[4], scale[4];
  for (int k = 0; k < 4; ++k) scale[k] = g[k][k] > 0 ? 1 / std::sqrt(g[k][k]) : 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = g[i][j] * scale[i] * scale[j] + (i == j ? 1e-10 : 0);
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / l[j][j];
    }
    y[i] = g[i][4] * scale[i];
    for (int k = 0; k < i; ++k) y[i] -= l[i][k] * y[k];
    y[i] /= l[i][i];
  }
  for (int i = 3; i >= 0; --i) {
    for (int k = i + 1; k < 4; ++k) y[i] -= l[k][i] * y[k];
    y[i] /= l[i][i];
  }
  for (int i = 0; i < 4; ++i) x[i] = std::isfinite(y[i]) ? y[i] * scale[i] : 0;
}

/// De Casteljau at ½ down to at most three points; returns how many are left.
int reduce(Vec4* b, int degree) {
  int n = degree + 1;
  while (n > 3) {
    for (int i = 0; i + 1 < n; ++i) b[i] = (b[i] + b[i + 1]) * 0.5;
    --n;
  }
  return n;
}

SurfaceJet jet_at_middle(const BezierPatch& patch) {
  std::array<Vec4, 32> row;
  std::array<Middle, 32> across;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) row[j] = patch.pole(i, j);
    across[i] = middle(row.data(), reduce(row.data(), patch.degree_v), patch.degree_v);
  }
  auto along = [&](auto member) {
    for (int i = 0; i <= patch.degree_u; ++i) row[i] = across[i].*member;
    return middle(row.data(), reduce(row.data(), patch.degree_u), patch.degree_u);
  };
  const Middle v0 = along(&Middle::value), v1 = along(&Middle::first), v2 = along(&Middle::second);
  // Quotient rule: with h = w·p, p = h / w.
  const double w = v0.value.w;
  SurfaceJet jet;
  jet.p = xyz(v0.value) / w;
  jet.pu = (xyz(v0.first) - jet.p * v0.first.w) / w;
  jet.pv = (xyz(v1.value) - jet.p * v1.value.w) / w;
  jet.puu = (xyz(v0.second) - jet.pu * (2 * v0.first.w) - jet.p * v0.second.w) / w;
  jet.puv = (xyz(v1.first) - jet.pu * v1.value.w - jet.pv * v0.first.w - jet.p * v1.first.w) / w;
  jet.pvv = (xyz(v2.value) - jet.pv * (2 * v1.value.w) - jet.p * v2.value.w) / w;
  return jet;
}

Range operator+(Range a, Range b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
Range operator*(Range a, double s) {
  return s >= 0 ? Range{a.lo * s, a.hi * s} : Range{a.hi * s, a.lo * s};
}
Range product(Range a, Range b) {
  const double c[4] = {a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
  return {*std::min_element(c, c + 4), *std::max_element(c, c + 4)};
}

/// Affine change of parameter from [0,1] to [lo,hi] of a Bézier polynomial, by blossoming; any lo < hi.
void reparametrise(Vec4* b, int degree, int stride, double lo, double hi) {
  std::array<Vec4, 32> p, out;
  for (int i = 0; i <= degree; ++i) p[i] = b[i * stride];
  // One side of the triangle at hi gives the poles over [0,hi]; of those the other side of the triangle at
  // lo/hi, the poles over [lo,hi].
  for (int k = 0; k <= degree; ++k) {
    out[k] = p[0];
    for (int i = 0; i + 1 <= degree - k; ++i) p[i] = p[i] * (1 - hi) + p[i + 1] * hi;
  }
  const double r = lo / hi;
  for (int k = 0; k <= degree; ++k) {
    b[(degree - k) * stride] = out[degree - k];
    for (int i = 0; i + 1 <= degree - k; ++i) out[i] = out[i] * (1 - r) + out[i + 1] * r;
  }
}

}  // namespace

CollapsedSides collapsed_sides(const BezierPatch& patch) {
  const Box3 box = poles_box(patch);
  const double eps = 1e-10 * box.diagonal();
  auto single = [&](auto pole, int count) {
    for (int k = 1; k <= count; ++k)
      if (distance(dehomogenised(pole(k)), dehomogenised(pole(0))) > eps) return false;
    return true;
  };
  const int p = patch.degree_u, q = patch.degree_v;
  return {
      single([&](int k) { return patch.pole(0, k); }, q), single([&](int k) { return patch.pole(p, k); }, q),
      single([&](int k) { return patch.pole(k, 0); }, p), single([&](int k) { return patch.pole(k, q); }, p)};
}

namespace {

/// The patch over [0, at] and what is left, along one parameter.
void cut_patch(BezierPatch& rest, bool along_u, double at, BezierPatch& first) {
  first = rest;
  const int degree = along_u ? rest.degree_u : rest.degree_v, lines = along_u ? rest.degree_v : rest.degree_u;
  const int stride = along_u ? rest.degree_v + 1 : 1, line_stride = along_u ? 1 : rest.degree_v + 1;
  for (int l = 0; l <= lines; ++l) {
    Vec4* a = first.poles.data() + l * line_stride;
    Vec4* b = rest.poles.data() + l * line_stride;
    for (int k = 1; k <= degree; ++k) {
      for (int i = 0; i <= degree - k; ++i)
        b[i * stride] = b[i * stride] * (1 - at) + b[(i + 1) * stride] * at;
      a[k * stride] = b[0];
    }
  }
}

}  // namespace

std::vector<BezierPatch> split_patch(const BezierPatch& patch, int along_u, int along_v) {
  std::vector<BezierPatch> pieces;
  BezierPatch rest = patch, strip, piece;
  for (int i = along_u; i > 0; --i) {
    if (i > 1)
      cut_patch(rest, true, 1.0 / i, strip);
    else
      strip = std::move(rest);
    for (int j = along_v; j > 1; --j) {
      cut_patch(strip, false, 1.0 / j, piece);
      pieces.push_back(piece);
    }
    pieces.push_back(std::move(strip));
  }
  return pieces;
}

BezierPatch grown_patch(const BezierPatch& patch, const CellMargins& m) {
  BezierPatch grown = patch;
  for (int j = 0; j <= patch.degree_v; ++j)
    reparametrise(&grown.pole(0, j), patch.degree_u, patch.degree_v + 1, -m.side[3], 1 + m.side[1]);
  for (int i = 0; i <= patch.degree_u; ++i)
    reparametrise(&grown.pole(i, 0), patch.degree_v, 1, -m.side[0], 1 + m.side[2]);
  return grown;
}

Box3 poles_box(const BezierPatch& patch) {
  Box3 box;
  for (const Vec4& pole : patch.poles) box.add(dehomogenised(pole));
  return box;
}

bool CellFitter::place(const BezierPatch& cell, CellFit& out) {
  const SurfaceJet jet = jet_at_middle(cell);
  const Curvature k = principal_curvature(jet);
  if (!is_finite(k.n) || !is_finite(k.d1) || !std::isfinite(k.k1) || !std::isfinite(k.k2)) return false;
  const Vec3 n = cross(jet.pu, jet.pv);
  if (!(length(n) > 1e-9 * length(jet.pu) * length(jet.pv))) return false;
  QuadricDp& dp = out.dp;
  dp.origin = jet.p, dp.u = k.d1, dp.v = k.d2, dp.lambda_u = k.k1, dp.lambda_v = k.k2;
  jacobian_[0][0] = dot(jet.pu, dp.u), jacobian_[0][1] = dot(jet.pv, dp.u);
  jacobian_[1][0] = dot(jet.pu, dp.v), jacobian_[1][1] = dot(jet.pv, dp.v);
  return true;
}

void CellFitter::load(const BezierPatch& grown, const QuadricDp& dp) {
  const int p = grown.degree_u, q = grown.degree_v;
  const Vec3 n = dp.n();
  const auto bp = bernstein::binomials(p), bq = bernstein::binomials(q);
  rational_ = grown.rational;
  least_w_ = most_w_ = grown.poles[0].w;
  box_ = {};
  for (Net* net : {&x_, &y_, &z_, &w_}) net->reset(p, q);
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const Vec4& pole = grown.pole(i, j);
      const Vec3 d = xyz(pole) - dp.origin * pole.w;
      const Vec3 l{dot(d, dp.u), dot(d, dp.v), dot(d, n)};
      const double b = bp[i] * bq[j];
      x_.at(i, j) = l.x * b, y_.at(i, j) = l.y * b, z_.at(i, j) = l.z * b, w_.at(i, j) = pole.w * b;
      least_w_ = std::min(least_w_, pole.w), most_w_ = std::max(most_w_, pole.w);
      if (pole.w > 0) box_.add(l / pole.w);
    }
}

/// a, b, c by least squares on the Bernstein coefficients of F∘S, which is linear in them.
void CellFitter::fit_third_order(double tolerance, QuadricDp& dp) {
  const int p = 2 * x_.p, q = 2 * x_.q;
  bernstein::multiply(x_, z_, xz_);
  bernstein::multiply(y_, z_, yz_);
  bernstein::multiply(z_, z_, zz_);
  bernstein::multiply(z_, w_, f_);
  bernstein::add_product(x_, x_, -0.5 * dp.lambda_u, f_);
  bernstein::add_product(y_, y_, -0.5 * dp.lambda_v, f_);
  const auto bp = bernstein::binomials(p), bq = bernstein::binomials(q);
  double g[3][3] = {}, r[3] = {};
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const double s = 1 / (bp[i] * bq[j]),
                   e[3] = {xz_.at(i, j) * s, yz_.at(i, j) * s, 0.5 * zz_.at(i, j) * s}, t = f_.at(i, j) * s;
      for (int k = 0; k < 3; ++k) {
        r[k] += e[k] * t;
        for (int l = 0; l < 3; ++l) g[k][l] += e[k] * e[l];
      }
    }
  const double ax = std::max(-box_.lo.x, box_.hi.x), ay = std::max(-box_.lo.y, box_.hi.y),
               az = std::max(-box_.lo.z, box_.hi.z);
  const double room = az + tolerance;
  auto steep = [&] { return std::abs(dp.a) * ax + std::abs(dp.b) * ay + std::abs(dp.c) * room > kMostSteep; };
  // Where the cell is all but flat c means next to nothing, and comes out as large as it likes; likewise a
  // and b.
  for (int unknowns = 3; unknowns > 0; --unknowns) {
    Vec3 x = solve_ridge(g, r, unknowns);
    dp.a = x.x, dp.b = x.y, dp.c = x.z;
    if (is_finite(x) && !steep()) break;
    dp.a = dp.b = dp.c = 0;
    if (unknowns == 2) break;
  }
  for (std::size_t i = 0; i < f_.c.size(); ++i)
    f_.c[i] -= dp.a * xz_.c[i] + dp.b * yz_.c[i] + 0.5 * dp.c * zz_.c[i];
}

bool CellFitter::certify(const CellRequest& request, CellFit& out) {
  const double tolerance = request.tolerance;
  QuadricDp& dp = out.dp;
  const double value_bound = bernstein::magnitude(f_) / (least_w_ * least_w_);
  const double ax = std::max(-box_.lo.x, box_.hi.x), ay = std::max(-box_.lo.y, box_.hi.y),
               az = std::max(-box_.lo.z, box_.hi.z);
  // Between surface and quadric, which lies at most `tolerance` above or below it.
  const double gz = 1 - std::abs(dp.a) * ax - std::abs(dp.b) * ay - std::abs(dp.c) * (az + tolerance);
  if (!(gz >= kLeastSheet)) return false;
  out.bound = value_bound / gz + request.beyond.value;
  out.quadric_decides = !(out.bound <= tolerance);
  if (out.quadric_decides) return false;
  dp.z_lo = box_.lo.z - out.bound, dp.z_hi = box_.hi.z + out.bound;
  return certify_normals(request, gz, out);
}

/// Ranges of the derivative of A/W^power along one parameter, over the cell. Along a collapsed side that
/// derivative vanishes; divided by the distance to the side (in the other parameter) it does not, and neither
/// does the Jacobian's column: the gradient in the chart, which is what counts, stays the same.
Range CellFitter::derivative_range(const Net& numerator, bool along_u, int power) {
  const Side* collapsed = along_u ? divide_u_ : divide_v_;
  const auto derive = [&](const Net& a, Net& out) {
    along_u ? bernstein::derivative_u(a, out) : bernstein::derivative_v(a, out);
  };
  if (!rational_) {
    derive(numerator, d_);
    if (!collapsed) return bernstein::range(d_);
    bernstein::divide_by_side(d_, *collapsed, tmp_);
    return bernstein::range(tmp_);
  }
  // (A/W^k)' = (A' − k (A/W) W') / W^k. With a the value at the collapsed side, A − a W^k vanishes there and
  // may take A's place.
  const Net& w = power == 1 ? w_ : w_power_[power - 2];
  Net& a = shifted_;
  a = numerator;
  Range value;
  if (collapsed) {
    const bool at_end = *collapsed == Side::u1 || *collapsed == Side::v1;
    const std::size_t corner = at_end ? a.c.size() - 1 : 0;
    const double at_side = a.c[corner] / w.c[corner];
    for (std::size_t i = 0; i < a.c.size(); ++i) a.c[i] -= at_side * w.c[i];
    bernstein::divide_by_side(a, *collapsed, tmp_);
    value = bernstein::range(tmp_);
    derive(a, tmp_);
    bernstein::divide_by_side(tmp_, *collapsed, d_);
  } else {
    value = bernstein::range(a);
    derive(a, d_);
  }
  const Range over_w{1 / most_w_, 1 / least_w_};
  Range over_wk = over_w;
  for (int k = 1; k < power; ++k) over_wk = product(over_wk, over_w);
  derive(w_, dw_);
  const Range drift = product(product(value, over_w), bernstein::range(dw_)) * (-1.0 * power);
  return product(bernstein::range(d_) + drift, over_wk);
}

/// The Jacobian at the centre and its inverse, in the grown cell's parameters, divided as the derivatives are
/// (see derivative_range).
bool CellFitter::set_up_normals(const CollapsedSides& collapsed, const CellMargins& m) {
  if ((collapsed.u0 && collapsed.u1) || (collapsed.v0 && collapsed.v1)) return false;
  const double grow_u = 1 + m.side[3] + m.side[1], grow_v = 1 + m.side[0] + m.side[2];
  // The centre of the cell, as a parameter of the grown one.
  const double mid_u = (0.5 + m.side[3]) / grow_u, mid_v = (0.5 + m.side[0]) / grow_v;
  static constexpr Side kSides[4] = {Side::u0, Side::u1, Side::v0, Side::v1};
  divide_v_ = collapsed.u0 ? &kSides[0] : collapsed.u1 ? &kSides[1] : nullptr;
  divide_u_ = collapsed.v0 ? &kSides[2] : collapsed.v1 ? &kSides[3] : nullptr;
  const double over_u = divide_u_ ? 1 / (collapsed.v0 ? mid_v : 1 - mid_v) : 1;
  const double over_v = divide_v_ ? 1 / (collapsed.u0 ? mid_u : 1 - mid_u) : 1;
  double jac[2][2];
  for (int r = 0; r < 2; ++r)
    jac[r][0] = jacobian_[r][0] * grow_u * over_u, jac[r][1] = jacobian_[r][1] * grow_v * over_v;
  const double det = jac[0][0] * jac[1][1] - jac[0][1] * jac[1][0];
  if (!(std::abs(det) > 0)) return false;
  inverse_[0][0] = jac[1][1] / det, inverse_[0][1] = -jac[0][1] / det;
  inverse_[1][0] = -jac[1][0] / det, inverse_[1][1] = jac[0][0] / det;
  if (rational_) {
    bernstein::multiply(w_, w_, w_power_[0]);
    bernstein::multiply(w_power_[0], w_, w_power_[1]);
  }
  return true;
}

/// Bounds J J0⁻¹ − I over the cell: below 1 the chart is one to one, and |J⁻ᵀ g| <= |J0⁻ᵀ g| / (1 − twist).
double CellFitter::twist() {
  const Range xu = derivative_range(x_, true, 1), xv = derivative_range(x_, false, 1);
  const Range yu = derivative_range(y_, true, 1), yv = derivative_range(y_, false, 1);
  const Range b00 = xu * inverse_[0][0] + xv * inverse_[1][0],
              b01 = xu * inverse_[0][1] + xv * inverse_[1][1];
  const Range b10 = yu * inverse_[0][0] + yv * inverse_[1][0],
              b11 = yu * inverse_[0][1] + yv * inverse_[1][1];
  const double d0 = std::max(1 - b00.lo, b00.hi - 1), d1 = std::max(1 - b11.lo, b11.hi - 1);
  return std::sqrt(d0 * d0 + d1 * d1 + b01.magnitude() * b01.magnitude() + b10.magnitude() * b10.magnitude());
}

/// Largest |J0⁻ᵀ (∂/∂s, ∂/∂t)| of a net over W^power.
double CellFitter::gradient_bound(const Net& net, int power) {
  const Range fu = derivative_range(net, true, power), fv = derivative_range(net, false, power);
  return std::hypot((fu * inverse_[0][0] + fv * inverse_[1][0]).magnitude(),
                    (fu * inverse_[0][1] + fv * inverse_[1][1]).magnitude());
}

/// The cubic form of (x,y) that takes up most of what the quadric leaves of F∘S, by least squares on
/// Bernstein coefficients; the rest stays in cubic_rest_.
void CellFitter::fit_cubic(QuadricDp& dp) {
  bernstein::multiply(x_, x_, xx_), bernstein::multiply(x_, y_, xy_), bernstein::multiply(y_, y_, yy_);
  bernstein::multiply(xx_, x_, cubic_[0]), bernstein::multiply(xx_, y_, cubic_[1]);
  bernstein::multiply(xy_, y_, cubic_[2]), bernstein::multiply(yy_, y_, cubic_[3]);
  bernstein::multiply(f_, w_, cubic_rest_);
  const auto bp = bernstein::binomials(cubic_rest_.p), bq = bernstein::binomials(cubic_rest_.q);
  double g[4][5] = {};
  for (int i = 0; i <= cubic_rest_.p; ++i)
    for (int j = 0; j <= cubic_rest_.q; ++j) {
      const double s = 1 / (bp[i] * bq[j]), t = cubic_rest_.at(i, j) * s;
      double e[4];
      for (int k = 0; k < 4; ++k) e[k] = cubic_[k].at(i, j) * s;
      for (int k = 0; k < 4; ++k) {
        g[k][4] += e[k] * t;
        for (int l = 0; l <= k; ++l) g[k][l] += e[k] * e[l];
      }
    }
  double x[4];
  solve_cubic(g, x);
  for (int k = 0; k < 4; ++k) {
    dp.cubic[k] = x[k];
    for (std::size_t i = 0; i < cubic_rest_.c.size(); ++i) cubic_rest_.c[i] -= x[k] * cubic_[k].c[i];
  }
}

/// By how much a normal turns where the surface differs from the patch by `beyond`: (|Ds| |St| + |Ss| |Dt|) /
/// |Ss × St| in the chart that turns at most this much.
double CellFitter::turned_beyond(const Remainder& beyond, double twisted) const {
  // beyond's parameters run over [−1,1], these over [0,1].
  const double s = 2 * beyond.ds * std::hypot(inverse_[0][0], inverse_[0][1]),
               t = 2 * beyond.dt * std::hypot(inverse_[1][0], inverse_[1][1]);
  const double turn = (s + t) / (1 - twisted);
  return turn < 0.5 ? 2 * turn : 4;
}

bool CellFitter::certify_normals(const CellRequest& request, double gz, CellFit& out) {
  const double normal_tolerance = request.normal_tolerance;
  QuadricDp& dp = out.dp;
  const double twisted = twist();
  if (!(twisted <= kMostTwist)) return false;
  out.quadric_decides = true;
  const double ax = std::max(-box_.lo.x, box_.hi.x), ay = std::max(-box_.lo.y, box_.hi.y),
               az = std::max(-box_.lo.z, box_.hi.z);
  // From the surface's point to the quadric's, `bound` along z, the drawn slope (C − F)x / Fz changes by this
  // much a length.
  auto drift = [&] {
    const double* c = dp.cubic.data();
    const double cx = 3 * std::abs(c[0]) * ax * ax + 2 * std::abs(c[1]) * ax * ay + std::abs(c[2]) * ay * ay;
    const double cy = std::abs(c[1]) * ax * ax + 2 * std::abs(c[2]) * ax * ay + 3 * std::abs(c[3]) * ay * ay;
    const double fx = std::abs(dp.lambda_u) * ax + std::abs(dp.a) * az + cx,
                 fy = std::abs(dp.lambda_v) * ay + std::abs(dp.b) * az + cy;
    return std::hypot(std::abs(dp.a) / gz + std::abs(dp.c) * fx / (gz * gz),
                      std::abs(dp.b) / gz + std::abs(dp.c) * fy / (gz * gz));
  };
  const double over = 1 / ((1 - twisted) * gz), beyond = turned_beyond(request.beyond, twisted);
  out.normal_bound = gradient_bound(f_, 2) * over + out.bound * drift() + beyond;
  if (out.normal_bound <= normal_tolerance) return true;
  fit_cubic(dp);
  out.normal_bound = gradient_bound(cubic_rest_, 3) * over + out.bound * drift() + beyond;
  return out.normal_bound <= normal_tolerance;
}

CellFit CellFitter::fit(const BezierPatch& cell, const CellRequest& request) {
  CellFit out;
  const CollapsedSides collapsed = collapsed_sides(cell);
  out.margins = request.margins;
  const bool point[4] = {collapsed.v0, collapsed.u1, collapsed.v1, collapsed.u0};
  for (int k = 0; k < 4; ++k)
    if (point[k]) out.margins.side[k] = 0;
  const BezierPatch grown = grown_patch(cell, out.margins);
  const auto cut = [&out](bool along_u) { out.pieces_u = along_u ? 2 : 1, out.pieces_v = along_u ? 1 : 2; };
  const auto longer_side = [&] {
    double u = 0, v = 0;
    for (int i = 0; i <= cell.degree_u; ++i)
      for (int j = 0; j <= cell.degree_v; ++j) {
        if (i > 0)
          u = std::max(u, distance(dehomogenised(cell.pole(i, j)), dehomogenised(cell.pole(i - 1, j))) *
                              cell.degree_u);
        if (j > 0)
          v = std::max(v, distance(dehomogenised(cell.pole(i, j)), dehomogenised(cell.pole(i, j - 1))) *
                              cell.degree_v);
      }
    return u >= v;
  };
  cut(longer_side());
  if (!place(cell, out)) return out;
  load(grown, out.dp);
  if (!(least_w_ > 0)) return out;
  fit_third_order(request.tolerance, out.dp);
  out.valid = set_up_normals(collapsed, out.margins) && certify(request, out);
  if (!out.valid) {
    // Where the quadric is not close enough, along the parameter in which F∘S varies more; where the cell is
    // bent or twisted too much to be looked at that way, along its longer side.
    if (!out.quadric_decides) return out;
    bernstein::derivative_u(f_, tmp_), bernstein::derivative_v(f_, d_);
    const double u = bernstein::magnitude(tmp_), v = bernstein::magnitude(d_);
    if (u > 1.3 * v || v > 1.3 * u) cut(u > v);
    return out;
  }
  const int p = cell.degree_u, q = cell.degree_v;
  auto local = [&](int i, int j) { return Vec2{x_.at(i, j) / w_.at(i, j), y_.at(i, j) / w_.at(i, j)}; };
  auto own = [&](int i, int j) {
    const Vec3 d = dehomogenised(cell.pole(i, j)) - out.dp.origin;
    return Vec2{dot(d, out.dp.u), dot(d, out.dp.v)};
  };
  for (int i = 0; i <= p; ++i) {
    out.border[0].push_back(own(i, 0)), out.grown_border[0].push_back(local(i, 0));
    out.border[2].push_back(own(i, q)), out.grown_border[2].push_back(local(i, q));
  }
  for (int j = 0; j <= q; ++j) {
    out.border[1].push_back(own(p, j)), out.grown_border[1].push_back(local(p, j));
    out.border[3].push_back(own(0, j)), out.grown_border[3].push_back(local(0, j));
  }
  return out;
}

}  // namespace dupin
