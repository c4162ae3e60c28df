#include "trim_region.h"

#include <algorithm>
#include <cmath>

#include "../nurbs/bezier.h"
#include "../nurbs/bounds.h"

namespace dupin::exact {
namespace {

constexpr std::size_t kMaxRows = 4096;
constexpr int kLongestSearch = 200;

/// The range of u of a curve over [t0, t1], from poles or a circle about it; infinite where that says
/// nothing.
struct RangeOfU {
  double t0, t1;
  ParameterRange operator()(const LineOf<Vec2>& l) const {
    const double a = l.origin.x + t0 * l.direction.x, b = l.origin.x + t1 * l.direction.x;
    return {std::min(a, b), std::max(a, b)};
  }
  ParameterRange operator()(const CircleOf<Vec2>& c) const {
    return {c.center.x - c.radius, c.center.x + c.radius};
  }
  ParameterRange operator()(const EllipseOf<Vec2>& e) const {
    const double r = std::hypot(e.major * e.x.x, e.minor * e.y.x);
    return {e.center.x - r, e.center.x + r};
  }
  ParameterRange operator()(const Bspline2& spline) const {
    Bspline3 lifted{spline.degree, spline.knots, {}, spline.weights, spline.periodic};
    for (const Vec2& p : spline.poles) lifted.poles.push_back({p.x, p.y, 0});
    Box3 box;
    for (const BezierCurve3& piece : bezier_curves({lifted}, t0, t1)) box.add(bounding_box(piece));
    return {box.lo.x, box.hi.x};
  }
  template <class Other>
  ParameterRange operator()(const Other&) const {
    return {-INFINITY, INFINITY};
  }
};

}  // namespace

TrimRegion::TrimRegion(const Part& part, const Face& face)
    : box_(face.uv_box),
      period_u_(period_u(part.surfaces[face.surface])),
      period_v_(period_v(part.surfaces[face.surface])),
      untrimmed_(face.loops.empty()) {
  for (const Loop& loop : face.loops) add_loop(part, loop);
  if (!untrimmed_) sort_into_rows();
}

void TrimRegion::add_loop(const Part& part, const Loop& loop) {
  bool started = false;
  Vec2 first, last;
  for (const Trim& trim : loop) {
    const Edge& edge = part.edges[trim.edge];
    Vec2 from = point_at(trim.pcurve, edge.t0), to = point_at(trim.pcurve, edge.t1);
    if (trim.reversed) std::swap(from, to);
    if (started)
      add_bridge(last, from);
    else
      first = from;
    started = true;
    add_trim(trim, edge.t0, edge.t1);
    last = to;
  }
  if (started) add_bridge(last, first);
}

void TrimRegion::add_trim(const Trim& trim, double t0, double t1) {
  std::vector<double> ends{t0};
  const std::vector<double> turns = turns_in_v(trim.pcurve, t0, t1);
  ends.insert(ends.end(), turns.begin(), turns.end());
  ends.push_back(t1);
  Vec2 from = point_at(trim.pcurve, t0);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Vec2 to = point_at(trim.pcurve, ends[i + 1]);
    const ParameterRange u = std::visit(RangeOfU{ends[i], ends[i + 1]}, trim.pcurve.geometry);
    pieces_.push_back({&trim.pcurve, ends[i], ends[i + 1], from, to, std::min({u.lo, from.x, to.x}),
                       std::max({u.hi, from.x, to.x})});
    from = to;
  }
}

void TrimRegion::add_bridge(Vec2 from, Vec2 to) {
  if (from == to) return;
  widest_gap_ = std::max(widest_gap_, length(to - from));
  pieces_.push_back({nullptr, 0, 1, from, to, std::min(from.x, to.x), std::max(from.x, to.x)});
}

void TrimRegion::sort_into_rows() {
  for (const Piece& piece : pieces_) box_.add(piece.p0), box_.add(piece.p1);
  rows_.resize(std::clamp<std::size_t>(pieces_.size() * 2, 1, kMaxRows));
  const double height = box_.size().y, last = static_cast<double>(rows_.size() - 1);
  const auto row = [&](double v) {
    return static_cast<std::size_t>(
        height > 0 ? std::clamp((v - box_.lo.y) / height * static_cast<double>(rows_.size()), 0.0, last)
                   : 0.0);
  };
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    const auto [lo, hi] = std::minmax(pieces_[i].p0.y, pieces_[i].p1.y);
    if (lo == hi) continue;
    for (std::size_t r = row(lo); r <= row(hi); ++r) rows_[r].push_back(i);
  }
}

bool TrimRegion::crosses(const Piece& piece, Vec2 uv) const {
  if ((piece.p0.y > uv.y) == (piece.p1.y > uv.y) || uv.x > piece.most_u) return false;
  if (uv.x < piece.least_u) return true;
  const bool rising = piece.p1.y > piece.p0.y;
  if (!piece.curve) {
    const double side = cross(piece.p1 - piece.p0, uv - piece.p0);
    return rising ? side > 0 : side < 0;
  }
  double lo = piece.t0, hi = piece.t1, t = 0.5 * (lo + hi), u = piece.p0.x;
  for (int step = 0; step < kLongestSearch; ++step) {
    const CurveJet<Vec2> jet = evaluate(*piece.curve, t, 1);
    u = jet[0].x;
    const double off = jet[0].y - uv.y;
    if (off == 0) break;
    ((off > 0) == rising ? hi : lo) = t;
    const double newton = jet[1].y != 0 ? t - off / jet[1].y : hi;
    const double next = newton > lo && newton < hi && step % 4 != 3 ? newton : 0.5 * (lo + hi);
    if (next == t || !(next > lo && next < hi)) break;
    t = next;
  }
  return uv.x < u;
}

bool TrimRegion::inside(Vec2 uv) const {
  if (!box_.contains(uv)) return false;
  if (untrimmed_) return true;
  const double height = box_.size().y;
  const double at = height > 0 ? (uv.y - box_.lo.y) / height * static_cast<double>(rows_.size()) : 0;
  const auto row = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(rows_.size() - 1)));
  bool odd = false;
  for (const std::uint32_t i : rows_[row]) odd ^= crosses(pieces_[i], uv);
  return odd;
}

bool TrimRegion::contains(Vec2& uv) const {
  // Whole turns that bring the point into the loops' box.
  const auto turns = [](double x, double lo, double hi, double period) {
    return period > 0 ? std::pair(std::ceil((lo - x) / period), std::floor((hi - x) / period))
                      : std::pair(0.0, 0.0);
  };
  const auto [u0, u1] = turns(uv.x, box_.lo.x, box_.hi.x, period_u_);
  const auto [v0, v1] = turns(uv.y, box_.lo.y, box_.hi.y, period_v_);
  for (double i = u0; i <= u1; ++i)
    for (double j = v0; j <= v1; ++j) {
      const Vec2 moved{uv.x + i * period_u_, uv.y + j * period_v_};
      if (!inside(moved)) continue;
      uv = moved;
      return true;
    }
  return false;
}

}  // namespace dupin::exact
