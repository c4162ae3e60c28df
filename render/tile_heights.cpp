#include "tile_heights.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dupin {
namespace {

Interval operator+(const Interval& a, const Interval& b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
Interval times(const Interval& a, double k) {
  return k < 0 ? Interval{a.hi * k, a.lo * k} : Interval{a.lo * k, a.hi * k};
}
Interval times(const Interval& a, const Interval& b) {
  const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
  return {lo, hi};
}
/// Of x², x in the interval.
Interval square(const Interval& a) {
  const double l = a.lo * a.lo, h = a.hi * a.hi;
  return {a.lo <= 0 && a.hi >= 0 ? 0 : std::min(l, h), std::max(l, h)};
}
Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}
Interval over(const Interval& a, const Interval& positive) {
  return {a.lo / (a.lo < 0 ? positive.lo : positive.hi), a.hi / (a.hi < 0 ? positive.hi : positive.lo)};
}
double largest(const Interval& a) {
  return std::max(std::abs(a.lo), std::abs(a.hi));
}

/// Rounding of what is computed in double but drawn in float.
double slack_of(const Box2& box, double height) {
  return 2e-6 * (box.size().x + box.size().y + height);
}

/// z = at + slope·((x, y) − middle) + rest
struct Slab {
  Vec2 middle, slope;
  double at;
  Interval rest;
};

/// By Taylor's theorem, with z as a function of (x, y): its derivatives follow from those of F, and are
/// bounded where F_z has one sign.
std::optional<Slab> slab_of(const QuadricDp& d, const Box2& box, const Interval& z) {
  const Interval x{box.lo.x, box.hi.x}, y{box.lo.y, box.hi.y};
  const Interval fz = Interval{1, 1} + times(x, -d.a) + times(y, -d.b) + times(z, -d.c);
  const double sign = fz.hi < 0 ? -1 : 1;
  const Interval steep = times(fz, sign);
  if (!(steep.lo > 0.02 * steep.hi)) return {};
  const auto by_fz = [&](const Interval& a) { return over(times(a, sign), steep); };
  const Interval zx = by_fz(times(x, d.lambda_u) + times(z, d.a)),
                 zy = by_fz(times(y, d.lambda_v) + times(z, d.b));
  const Interval xx = by_fz(Interval{d.lambda_u, d.lambda_u} + times(zx, 2 * d.a) + times(square(zx), d.c)),
                 yy = by_fz(Interval{d.lambda_v, d.lambda_v} + times(zy, 2 * d.b) + times(square(zy), d.c)),
                 xy = by_fz(times(zy, d.a) + times(zx, d.b) + times(times(zx, zy), d.c));
  Slab s;
  s.middle = (box.lo + box.hi) * 0.5;
  const Vec2 half = box.size() * 0.5;
  // The root with this sign of F_z:  ½ c z² − p z + q = 0,  F_z = p − c z = ± its discriminant's root.
  const double p = 1 - d.a * s.middle.x - d.b * s.middle.y,
               q = (d.lambda_u * s.middle.x * s.middle.x + d.lambda_v * s.middle.y * s.middle.y) / 2,
               discriminant = p * p - 2 * d.c * q;
  if (!(discriminant > 0)) return {};
  const double root = sign * std::sqrt(discriminant);
  s.at = std::abs(p + root) > std::abs(p - root) ? 2 * q / (p + root) : (p - root) / d.c;
  if (!std::isfinite(s.at)) return {};
  s.slope = Vec2{d.lambda_u * s.middle.x + d.a * s.at, d.lambda_v * s.middle.y + d.b * s.at} / root;
  s.rest = times(times(xx, {0, half.x * half.x}), 0.5) + times(times(yy, {0, half.y * half.y}), 0.5);
  const double turn = largest(xy) * half.x * half.y, slack = slack_of(box, z.hi - z.lo);
  s.rest = {s.rest.lo - turn - slack, s.rest.hi + turn + slack};
  return s;
}

}  // namespace

/// From
///     ½ c z² − p z + q = 0,  p = 1 − a x − b y,  q = ½ (λu x² + λv y²).
Heights heights(const QuadricDp& dp, const Box2& box, const Interval& ends) {
  const Interval x{box.lo.x, box.hi.x}, y{box.lo.y, box.hi.y};
  const Interval p = Interval{1, 1} + times(x, -dp.a) + times(y, -dp.b);
  const Interval q = times(square(x), dp.lambda_u / 2) + times(square(y), dp.lambda_v / 2);
  if (!(p.lo > 0)) return {{ends, {}}, 1};
  const Interval d = square(p) + times(q, -2 * dp.c);
  if (d.hi < 0) return {};
  const Interval root{std::sqrt(std::max(0.0, d.lo)), std::sqrt(d.hi)}, sum = p + root;
  const double slack = slack_of(box, ends.hi - ends.lo);
  Heights h;
  const auto add = [&](Interval z) {
    z = common({z.lo - slack, z.hi + slack}, ends);
    if (z.empty()) return;
    if (h.count == 1 && z.lo <= h.z[0].hi && h.z[0].lo <= z.hi) {
      h.z[0] = {std::min(z.lo, h.z[0].lo), std::max(z.hi, h.z[0].hi)};
    } else {
      h.z[h.count++] = z;
    }
  };
  add(times(times(q, 2), {1 / sum.hi, 1 / sum.lo}));
  if (dp.c != 0) add(times(sum, 1 / dp.c));
  return h;
}

Hull hull_of(const QuadricDp& dp, const std::array<Vec2, 4>& corners, const Box2& box, const Interval& z) {
  const std::optional<Slab> slab = slab_of(dp, box, z);
  Hull hull;
  hull.slanting = slab && slab->rest.hi - slab->rest.lo < z.hi - z.lo;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 c = corners[i];
    const double at = hull.slanting ? slab->at + dot(slab->slope, c - slab->middle) : 0;
    hull.points[i] = {c.x, c.y, hull.slanting ? at + slab->rest.lo : z.lo};
    hull.points[i + 4] = {c.x, c.y, hull.slanting ? at + slab->rest.hi : z.hi};
  }
  const Vec2 size = box.size();
  const bool u = std::abs(dp.lambda_u) * size.x * size.x > std::abs(dp.lambda_v) * size.y * size.y;
  hull.thickness = hull.slanting
                       ? (slab->rest.hi - slab->rest.lo) / std::sqrt(1 + dot(slab->slope, slab->slope))
                       : std::min(z.hi - z.lo, u ? size.x : size.y);
  return hull;
}

}  // namespace dupin
