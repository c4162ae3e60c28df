#include "knot_strips.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dupin {
namespace {

constexpr int kOrders = SideStrip::kOrders;

/// Homogeneous coefficients of σ^k, each a Bernstein polynomial along the side.
using Rows = std::vector<std::vector<Vec4>>;

Vec4 scaled_sum(double a, const Vec4& x, double b, const Vec4& y) {
  return {a * x.x + b * y.x, a * x.y + b * y.y, a * x.z + b * y.z, a * x.w + b * y.w};
}

/// A patch at a side, σ counted from it into the patch, relative to a point.
Rows expansion(const BezierPatch& patch, int side, const Vec3& about) {
  const bool over_u = side % 2 == 1, from_end = side == 1 || side == 2;
  const int n = over_u ? patch.degree_u : patch.degree_v, m = over_u ? patch.degree_v : patch.degree_u;
  Rows rows(static_cast<std::size_t>(n + 1), std::vector<Vec4>(static_cast<std::size_t>(m + 1)));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const int at = from_end ? n - i : i;
      const Vec4& b = over_u ? patch.pole(at, j) : patch.pole(j, at);
      rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = {
          b.x - about.x * b.w, b.y - about.y * b.w, b.z - about.z * b.w, b.w};
    }
  double binomial = 1;
  for (int k = 1; k <= n; ++k) {
    for (int i = n; i >= k; --i)
      for (std::size_t j = 0; j < rows[0].size(); ++j)
        rows[static_cast<std::size_t>(i)][j] =
            scaled_sum(1, rows[static_cast<std::size_t>(i)][j], -1, rows[static_cast<std::size_t>(i - 1)][j]);
  }
  for (int k = 1; k <= n; ++k) {
    binomial *= static_cast<double>(n - k + 1) / k;
    for (Vec4& b : rows[static_cast<std::size_t>(k)]) b = scaled_sum(binomial, b, 0, b);
  }
  rows.resize(kOrders, std::vector<Vec4>(rows[0].size()));
  return rows;
}

/// f(r1 σ + r2 σ²), orders beyond the last left out.
Rows at_speed(const Rows& f, double r1, double r2) {
  Rows out(f.size(), std::vector<Vec4>(f[0].size()));
  std::array<double, kOrders> power{1};
  for (int k = 0; k < kOrders; ++k) {
    for (int i = k; i < kOrders; ++i)
      if (const double c = power[static_cast<std::size_t>(i)]; c != 0)
        for (std::size_t j = 0; j < f[0].size(); ++j) {
          Vec4& to = out[static_cast<std::size_t>(i)][j];
          to = scaled_sum(1, to, c, f[static_cast<std::size_t>(k)][j]);
        }
    std::array<double, kOrders> next{};
    for (int i = k; i < kOrders; ++i) {
      if (i + 1 < kOrders) next[static_cast<std::size_t>(i + 1)] += r1 * power[static_cast<std::size_t>(i)];
      if (i + 2 < kOrders) next[static_cast<std::size_t>(i + 2)] += r2 * power[static_cast<std::size_t>(i)];
    }
    power = next;
  }
  return out;
}

/// Coefficients of products of two Bernstein polynomials.
double product_weight(std::size_t n, std::size_t i, std::size_t j) {
  const auto choose = [](std::size_t a, std::size_t b) {
    double c = 1;
    for (std::size_t k = 0; k < b; ++k) c = c * static_cast<double>(a - k) / static_cast<double>(k + 1);
    return c;
  };
  return choose(n, i) * choose(n, j) / choose(2 * n, i + j);
}

/// to += sign · x·W_y, along the side.
void add_product(double sign, const std::vector<Vec4>& x, const std::vector<Vec4>& y, std::vector<Vec3>& to) {
  const std::size_t n = x.size() - 1;
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t j = 0; j <= n; ++j) {
      const double s = sign * product_weight(n, i, j) * y[j].w;
      if (s != 0) to[i + j] += Vec3{x[i].x, x[i].y, x[i].z} * s;
    }
}

/// The numerators of B/W_B − A/W_A, by order.
std::vector<std::vector<Vec3>> difference(const Rows& a, const Rows& b, bool rational, int orders) {
  const std::size_t n = a[0].size() - 1;
  std::vector<std::vector<Vec3>> d(static_cast<std::size_t>(orders),
                                   std::vector<Vec3>((rational ? 2 * n : n) + 1));
  for (std::size_t k = 0; k < d.size(); ++k) {
    if (rational) {
      for (std::size_t i = 0; i <= k; ++i)
        add_product(1, b[i], a[k - i], d[k]), add_product(-1, a[i], b[k - i], d[k]);
    } else {
      for (std::size_t j = 0; j <= n; ++j)
        d[k][j] = Vec3{b[k][j].x - a[k][j].x, b[k][j].y - a[k][j].y, b[k][j].z - a[k][j].z};
    }
  }
  return d;
}

/// What takes most of an order of the difference away, in terms of what the first order of B contributes to
/// it.
double fitted_speed(const std::vector<Vec3>& whole, const std::vector<Vec3>& part) {
  double top = 0, bottom = 0;
  for (std::size_t j = 0; j < whole.size(); ++j)
    top -= dot(whole[j], part[j]), bottom += dot(part[j], part[j]);
  return bottom > 0 ? top / bottom : 0;
}

/// The neighbour run through so that it differs least.
Rows matched(const Rows& a, const Rows& b, bool rational, double guess) {
  // By ρ1: the first order of the difference is linear in it.
  Rows still = b;
  for (std::size_t k = 1; k < still.size(); ++k)
    for (Vec4& p : still[k]) p = {};
  const auto at_rest = difference(a, still, rational, 2),
             moving = difference(a, at_speed(b, 1, 0), rational, 2);
  std::vector<Vec3> part = moving[1];
  for (std::size_t j = 0; j < part.size(); ++j) part[j] = part[j] - at_rest[1][j];
  double r1 = fitted_speed(at_rest[1], part);
  if (!(r1 > 0.01 * guess && r1 < 100 * guess)) r1 = guess;
  if (std::abs(r1 - guess) < 1e-9 * guess) r1 = guess;
  // By ρ2: it brings ρ2 times the same into the second order.
  const auto second = difference(a, at_speed(b, r1, 0), rational, 3);
  const double r2 = fitted_speed(second[2], part);
  return at_speed(b, r1, std::abs(r2) < 10 * r1 ? r2 : 0);
}

template <class T>
double largest(const std::vector<T>& v, double (*size)(const T&)) {
  double most = 0;
  for (const T& x : v) most = std::max(most, size(x));
  return most;
}
template <class T>
double largest_step(const std::vector<T>& v, double (*distance)(const T&, const T&)) {
  double most = 0;
  for (std::size_t j = 0; j + 1 < v.size(); ++j) most = std::max(most, distance(v[j], v[j + 1]));
  return most * static_cast<double>(v.size() - 1);
}

void note_weights(const Rows& rows, int which, SideStrip& out) {
  const auto w = static_cast<std::size_t>(which);
  out.least_weight[w] = 1e300;
  for (const Vec4& p : rows[0]) out.least_weight[w] = std::min(out.least_weight[w], p.w);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out.weight[w][k] = largest<Vec4>(rows[k], [](const Vec4& p) { return std::abs(p.w); });
    out.weight_along[w][k] =
        largest_step<Vec4>(rows[k], [](const Vec4& p, const Vec4& q) { return std::abs(q.w - p.w); });
  }
}

/// Σ c_k σ^k from the first-th order on, and its derivative.
double sum(const std::array<double, kOrders>& c, double sigma, std::size_t first) {
  double s = 0;
  for (std::size_t k = c.size(); k-- > first;) s = s * sigma + c[k];
  return s * std::pow(sigma, static_cast<double>(first));
}
double slope(const std::array<double, kOrders>& c, double sigma) {
  double s = 0;
  for (std::size_t k = c.size(); k-- > 1;) s = s * sigma + static_cast<double>(k) * c[k];
  return s;
}

std::vector<double> sorted_starts(const std::vector<const BezierPatch*>& patches, bool u) {
  std::vector<double> starts;
  for (const BezierPatch* p : patches) starts.push_back(u ? p->domain.lo.x : p->domain.lo.y);
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  return starts;
}

}  // namespace

Remainder SideStrip::at(double sigma) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (smooth) return {};
  if (!(sigma <= kMostSigma)) return {kInfinity, kInfinity, kInfinity};
  Remainder r{sum(value, sigma, 0), slope(value, sigma), sum(along, sigma, 0)};
  if (!rational) return r;
  double least = 1, over = 0, beside = 0;
  for (std::size_t w = 0; w < 2; ++w) {
    const double weight_here = least_weight[w] - sum(weight[w], sigma, 1);
    if (!(weight_here > 0)) return {kInfinity, kInfinity, kInfinity};
    least *= weight_here;
    over += slope(weight[w], sigma) / weight_here, beside += sum(weight_along[w], sigma, 0) / weight_here;
  }
  r = r * (1 / least);
  return {r.value, r.ds + r.value * over, r.dt + r.value * beside};
}

KnotStrips::KnotStrips(std::vector<const BezierPatch*> patches, bool wrap_u, bool wrap_v)
    : patches_(std::move(patches)),
      u_(sorted_starts(patches_, true)),
      v_(sorted_starts(patches_, false)),
      grid_(u_.size() * v_.size(), -1),
      place_(patches_.size()),
      wrap_u_(wrap_u),
      wrap_v_(wrap_v) {
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const auto column = std::lower_bound(u_.begin(), u_.end(), patches_[i]->domain.lo.x) - u_.begin(),
               row = std::lower_bound(v_.begin(), v_.end(), patches_[i]->domain.lo.y) - v_.begin();
    u_end_ = i == 0 ? patches_[i]->domain.hi.x : std::max(u_end_, patches_[i]->domain.hi.x);
    v_end_ = i == 0 ? patches_[i]->domain.hi.y : std::max(v_end_, patches_[i]->domain.hi.y);
    place_[i] = static_cast<int>(column) * static_cast<int>(v_.size()) + static_cast<int>(row);
    grid_[static_cast<std::size_t>(place_[i])] = static_cast<int>(i);
  }
}

int KnotStrips::neighbour(std::size_t patch, int side) const {
  int column = place_[patch] / rows(), row = place_[patch] % rows();
  if (side % 2 == 1)
    column += side == 1 ? 1 : -1;
  else
    row += side == 2 ? 1 : -1;
  return index(column, row);
}

int KnotStrips::index(int column, int row) const {
  if (wrap_u_) column = (column + columns()) % columns();
  if (wrap_v_) row = (row + rows()) % rows();
  if (column < 0 || column >= columns() || row < 0 || row >= rows()) return -1;
  return grid_[static_cast<std::size_t>(column * rows() + row)];
}

double KnotStrips::start(const std::vector<double>& starts, double end, int i) {
  const int n = static_cast<int>(starts.size());
  if (i < 0) return starts[static_cast<std::size_t>(i + n)] - (end - starts[0]);
  if (i > n) return starts[static_cast<std::size_t>(i - n)] + (end - starts[0]);
  return i == n ? end : starts[static_cast<std::size_t>(i)];
}

SideStrip KnotStrips::strip(std::size_t patch, int side) const {
  SideStrip out;
  const int other = neighbour(patch, side);
  const BezierPatch& own = *patches_[patch];
  // An arc carried on is the same circle.
  if (other < 0 || (side % 2 == 1 ? own.u_is_angle : own.v_is_angle)) return out;
  const BezierPatch& next = *patches_[static_cast<std::size_t>(other)];
  if (next.degree_u != own.degree_u || next.degree_v != own.degree_v) return out;
  out.smooth = false, out.rational = own.rational || next.rational;
  const Vec4& first = own.poles[0];
  const Vec3 about = Vec3{first.x, first.y, first.z} / first.w;
  Rows a = expansion(own, side, about);
  for (std::size_t k = 1; k < a.size(); k += 2)
    for (Vec4& p : a[k]) p = scaled_sum(-1, p, 0, p);
  const Vec2 size = own.domain.size(), next_size = next.domain.size();
  const Rows b = matched(a, expansion(next, (side + 2) % 4, about), out.rational,
                         side % 2 == 1 ? size.x / next_size.x : size.y / next_size.y);
  const auto d = difference(a, b, out.rational, kOrders);
  for (std::size_t k = 0; k < d.size(); ++k) {
    out.value[k] = largest<Vec3>(d[k], [](const Vec3& x) { return length(x); });
    out.along[k] = largest_step<Vec3>(d[k], [](const Vec3& x, const Vec3& y) { return length(y - x); });
  }
  if (out.rational) note_weights(a, 0, out), note_weights(b, 1, out);
  return out;
}

}  // namespace dupin
