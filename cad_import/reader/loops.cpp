#include "loops.h"

#include <algorithm>
#include <cmath>

#include "curve_tools.h"

namespace dupin::reader {
namespace {

// Lengths in space of unit steps in u and v: the largest at the uses' ends, so that a pole does not hide a
// gap.
struct Metric {
  double u = 0, v = 0;
  double operator()(Vec2 d) const { return u * std::abs(d.x) + v * std::abs(d.y); }
};

Metric metric_of(const Surface& surface, const std::vector<EdgeUse>& uses) {
  Metric m;
  for (const EdgeUse& use : uses)
    for (const double t : {use.t0, (use.t0 + use.t1) / 2}) {
      const Vec2 q = point_at(use.trim.pcurve, t);
      const SurfaceJet s = evaluate(surface, q.x, q.y, 1);
      m.u = std::max(m.u, length(s.pu)), m.v = std::max(m.v, length(s.pv));
    }
  return m;
}

Vec2 extent_of(const std::vector<EdgeUse>& uses) {
  Box2 box;
  for (const EdgeUse& use : uses)
    for (int i = 0; i <= 8; ++i) box.add(point_at(use.trim.pcurve, use.t0 + (use.t1 - use.t0) * i / 8));
  return box.size();
}

// Part of the loop's own extent that a gap may have without being filled in: slivers are thinner than any
// tolerance.
constexpr double kGapOfExtent = 0.002;

// The width of a domain whose opposite sides meet in space without the surface being periodic; 0 if they do
// not.
double closure(const Surface& surface, bool in_u, double tolerance) {
  const Box2 box = domain(surface);
  const double lo = in_u ? box.lo.x : box.lo.y, hi = in_u ? box.hi.x : box.hi.y;
  const double across_lo = in_u ? box.lo.y : box.lo.x, across_hi = in_u ? box.hi.y : box.hi.x;
  if (!(std::abs(lo) < 1e50 && std::abs(hi) < 1e50 && std::abs(across_lo) < 1e50 &&
        std::abs(across_hi) < 1e50))
    return 0;
  for (int i = 0; i <= 8; ++i) {
    const double s = across_lo + (across_hi - across_lo) * i / 8;
    const Vec3 a = in_u ? point_at(surface, lo, s) : point_at(surface, s, lo);
    const Vec3 b = in_u ? point_at(surface, hi, s) : point_at(surface, s, hi);
    if (!(distance(a, b) <= tolerance)) return 0;
  }
  return hi - lo;
}

class Assembly {
 public:
  Assembly(const Surface& surface, std::vector<EdgeUse> uses, double tolerance)
      : surface_(surface),
        left_(std::move(uses)),
        tolerance_(tolerance),
        metric_(metric_of(surface, left_)),
        extent_(extent_of(left_)) {}

  WireLoops run() {
    while (!left_.empty()) {
      std::vector<EdgeUse> loop{take(0)};
      while (!left_.empty()) {
        const std::size_t next = best_follower(loop);
        if (next == left_.size()) break;
        append(loop, take(next));
      }
      close(loop);
      result_.loops.push_back(std::move(loop));
    }
    return std::move(result_);
  }

 private:
  EdgeUse take(std::size_t i) {
    EdgeUse use = std::move(left_[i]);
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
    return use;
  }

  double distance_to(const EdgeUse& use, const EdgeUse& before) const {
    const Vec2 d = use.file_start - before.file_end;
    return metric_(d - whole_periods(surface_, d)) + 1e-3 * metric_(whole_periods(surface_, d));
  }

  // The use that begins where the loop now ends: at the same vertex, nearest in parameters. None if the loop
  // has come back to its beginning and nothing goes on from there in parameters either.
  std::size_t best_follower(const std::vector<EdgeUse>& loop) const {
    const Vec2 end = loop.back().end();
    const int vertex = loop.back().to;
    std::size_t best = left_.size();
    double least = std::numeric_limits<double>::infinity();
    bool certain = !loop.back().file_wrong;
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (left_[i].from == vertex && left_[i].file_wrong) certain = false;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (vertex < 0 || left_[i].from != vertex) continue;
      if (!certain) return i;
      const double d = distance_to(left_[i], loop.back());
      if (d < least) least = d, best = i;
    }
    const bool back = vertex >= 0 && vertex == loop.front().from;
    const double closing = metric_(loop.front().start() - end);
    if (back && closing <= tolerance_ && !(least <= tolerance_ && turns_into_seam(loop, best)))
      return left_.size();
    if (best < left_.size() || back) return best;
    return nearest_in_space(end);
  }

  // A loop that runs along a seam and back must not be closed before it has come back.
  bool turns_into_seam(const std::vector<EdgeUse>& loop, std::size_t next) const {
    if (left_[next].trim.seam) return true;
    return std::any_of(loop.begin(), loop.end(), [&](const EdgeUse& u) { return u.trim.seam; });
  }

  std::size_t nearest_in_space(Vec2 end) const {
    const Vec3 p = point_at(surface_, end.x, end.y);
    std::size_t best = left_.size();
    double least = 10 * tolerance_;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Vec2 s = left_[i].start();
      const double d = distance(point_at(surface_, s.x, s.y), p);
      if (d < least) least = d, best = i;
    }
    return best;
  }

  void append(std::vector<EdgeUse>& loop, EdgeUse use) {
    const Vec2 end = loop.back().end(), d = use.start() - end;
    const Vec2 turns = whole_periods(surface_, d);
    if (turns.x != 0 || turns.y != 0) translate(use.trim.pcurve, -turns);
    if (metric_(d - turns) > 10 * tolerance_) move_to_other_side(use, end);
    bridge(loop, use.start() - end, use.start());
    loop.push_back(std::move(use));
  }

  // An edge along the line where a surface closes has its pcurve on either side of the domain.
  void move_to_other_side(EdgeUse& use, Vec2 end) const {
    const Box2 along = bounds(use.trim.pcurve, use.t0, use.t1);
    const Vec2 d = use.start() - end;
    for (const bool in_u : {true, false}) {
      const double gap = in_u ? d.x : d.y, thickness = in_u ? along.size().x : along.size().y;
      const double width = closure(surface_, in_u, 10 * tolerance_);
      if (width == 0 || std::abs(std::abs(gap) - width) > 0.02 * width || thickness > 0.02 * width) continue;
      const double by = gap > 0 ? -width : width;
      translate(use.trim.pcurve, in_u ? Vec2{by, 0} : Vec2{0, by});
    }
  }

  void close(std::vector<EdgeUse>& loop) {
    const Vec2 d = loop.front().start() - loop.back().end();
    const Vec2 turns = whole_periods(surface_, d);
    if (turns.x != 0 || turns.y != 0)
      result_.winding = true;
    else
      bridge(loop, d, loop.front().start());
  }

  // Joins the loop's end with `to`, which lies `d` further on, where they differ.
  void bridge(std::vector<EdgeUse>& loop, Vec2 d, Vec2 to) {
    if (length(d) <= 1e-14 * (1 + length(to))) return;
    if (metric_(d) <= tolerance_ && std::abs(d.x) <= kGapOfExtent * extent_.x &&
        std::abs(d.y) <= kGapOfExtent * extent_.y) {
      result_.gap = std::max(result_.gap, metric_(d));
      return;
    }
    const Vec2 from = loop.back().end();
    const Vec3 p = point_at(surface_, from.x, from.y);
    double off = 0;  // nothing at a pole: a collapsed side stays at one point all the way
    for (int i = 1; i <= 4; ++i) {
      const Vec2 q = from + (to - from) * (i / 4.0);
      off = std::max(off, distance(point_at(surface_, q.x, q.y), p));
    }
    result_.gap = std::max(result_.gap, off);
    EdgeUse side;
    side.trim.edge = kNewDegenerateEdge;
    side.trim.degenerate = true;
    side.trim.pcurve = segment(from, to, 0, 1);
    side.t1 = 1;
    side.from = side.to = loop.back().to;
    side.file_start = side.file_end = loop.back().file_end;
    loop.push_back(std::move(side));
  }

  const Surface& surface_;
  std::vector<EdgeUse> left_;
  double tolerance_;
  Metric metric_;
  Vec2 extent_;
  WireLoops result_;
};

}  // namespace

WireLoops assemble_loops(const Surface& surface, std::vector<EdgeUse> uses, double tolerance) {
  for (const EdgeUse& use : uses) tolerance = std::max(tolerance, use.tolerance);
  return Assembly(surface, std::move(uses), tolerance).run();
}

Vec2 whole_periods(const Surface& surface, Vec2 step) {
  const double turn_u = period_u(surface), turn_v = period_v(surface);
  return {turn_u > 0 ? std::round(step.x / turn_u) * turn_u : 0,
          turn_v > 0 ? std::round(step.y / turn_v) * turn_v : 0};
}

double signed_area(const std::vector<EdgeUse>& loop) {
  constexpr int kSamples = 16;
  double area = 0;
  const Vec2 origin = loop.front().start();
  Vec2 last{};
  for (const EdgeUse& use : loop)
    for (int i = 0; i <= kSamples; ++i) {
      const double s = static_cast<double>(i) / kSamples;
      const double t = use.trim.reversed ? use.t1 + (use.t0 - use.t1) * s : use.t0 + (use.t1 - use.t0) * s;
      const Vec2 p = point_at(use.trim.pcurve, t) - origin;
      area += cross(last, p);
      last = p;
    }
  return area;
}

}  // namespace dupin::reader
