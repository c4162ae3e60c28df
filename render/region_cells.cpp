#include "region_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dupin {
namespace {

constexpr int kMostHalvings = 3;
constexpr int kArcsOfEllipse = 8;
/// An arc's pole farther than this many chords from its chord's middle makes a triangle too large to be of
/// use.
constexpr double kFarPole = 1.0;
/// Of the footprint's extent: what is smaller is rounding.
constexpr double kTiny = 1e-11;
/// Of the extent: an arc that is flatter is its chord, to the last digits of a float.
constexpr double kFlat = 1e-7;

struct Segment {
  Vec2 a, b;
  double at(double x) const {
    const double t = (x - a.x) / (b.x - a.x);
    return a.y + t * (b.y - a.y);
  }
};

/// A convex part of the plane around a conic piece: a triangle (its last corner repeated) or a parallelogram.
struct Hull {
  std::array<Vec2, 4> corners;
  ConicTest conic;
  Vec2 inner;  ///< a point on the conic's inner side
  std::size_t sides() const { return corners[2].x == corners[3].x && corners[2].y == corners[3].y ? 3 : 4; }
  bool arc = false;
  int halvings = 0;
  ArcPiece piece;        ///< of an arc
  EllipsePiece ellipse;  ///< otherwise
};

LinearForm line_through(Vec2 a, Vec2 b, double scale) {
  return {-(b.y - a.y) * scale, (b.x - a.x) * scale, cross(a, b) * scale};
}
LinearForm times(const LinearForm& f, double k) {
  return {f.x * k, f.y * k, f.one * k};
}

double slope(const ConicTest& t, Vec2 p) {
  const double a = t.a.at(p), b = t.b.at(p), c = t.c.at(p);
  return std::hypot(a * t.b.x + b * t.a.x - 2 * c * t.c.x, a * t.b.y + b * t.a.y - 2 * c * t.c.y);
}

Vec2 arc_point(const ArcPiece& p, double t) {
  const double b0 = (1 - t) * (1 - t), b1 = 2 * t * (1 - t) * p.w, b2 = t * t;
  return (p.p0 * b0 + p.p1 * b1 + p.p2 * b2) / (b0 + b1 + b2);
}

/// With barycentric coordinates, b1² < 4 w² b0 b2.
Hull arc_hull(const ArcPiece& given, int halvings) {
  Hull h;
  ArcPiece p = given;
  if (cross(p.p1 - p.p0, p.p2 - p.p0) < 0) std::swap(p.p0, p.p2);
  const double area = cross(p.p1 - p.p0, p.p2 - p.p0);
  h.arc = true, h.halvings = halvings, h.piece = given;
  h.corners = {p.p0, p.p1, p.p2, p.p2};
  // Lines with the triangle on their left: p1 p2 is opposite to p0, and so on.
  h.conic.a = times(line_through(p.p1, p.p2, 1 / area), 2 * p.w);
  h.conic.b = times(line_through(p.p0, p.p1, 1 / area), 2 * p.w);
  h.conic.c = line_through(p.p2, p.p0, 1 / area);
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0})
    h.conic.steepest = std::max(h.conic.steepest, slope(h.conic, arc_point(p, t)));
  h.inner = ((p.p0 + p.p2) * 0.5 + arc_point(p, 0.5)) * 0.5;
  return h;
}

/// 1 − |m (p − c)|² = (1 − q)(1 + q) − r².
Hull ellipse_hull(const EllipsePiece& e) {
  Hull h;
  h.ellipse = e, h.inner = e.center;
  const double det = e.mxx * e.myy - e.mxy * e.mxy;
  const auto point = [&](double q, double r) {
    return e.center + Vec2{e.myy * q - e.mxy * r, e.mxx * r - e.mxy * q} / det;
  };
  h.corners = {point(-1, -1), point(1, -1), point(1, 1), point(-1, 1)};
  const LinearForm q{e.mxx, e.mxy, -(e.mxx * e.center.x + e.mxy * e.center.y)},
      r{e.mxy, e.myy, -(e.mxy * e.center.x + e.myy * e.center.y)};
  h.conic.a = {-q.x, -q.y, 1 - q.one};
  h.conic.b = {q.x, q.y, 1 + q.one};
  h.conic.c = r;
  for (const Vec2 p : {point(1, 0), point(0, 1), point(std::sqrt(0.5), std::sqrt(0.5)),
                       point(std::sqrt(0.5), -std::sqrt(0.5))})
    h.conic.steepest = std::max(h.conic.steepest, slope(h.conic, p));
  return h;
}

std::array<ArcPiece, kArcsOfEllipse> arcs_of(const EllipsePiece& e) {
  const double det = e.mxx * e.myy - e.mxy * e.mxy, step = 2 * 3.14159265358979323846 / kArcsOfEllipse,
               w = std::cos(step / 2);
  const auto point = [&](double angle, double radius) {
    const Vec2 q{std::cos(angle) * radius, std::sin(angle) * radius};
    return e.center + Vec2{e.myy * q.x - e.mxy * q.y, e.mxx * q.y - e.mxy * q.x} / det;
  };
  std::array<ArcPiece, kArcsOfEllipse> arcs;
  for (std::size_t k = 0; k < kArcsOfEllipse; ++k) {
    const auto i = static_cast<double>(k);
    arcs[k] = {point(i * step, 1), point((i + 0.5) * step, 1 / w), point((i + 1) * step, 1), w, e.feature};
    if (k > 0) arcs[k].p0 = arcs[k - 1].p2;
  }
  arcs.back().p2 = arcs.front().p0;
  return arcs;
}

std::array<ArcPiece, 2> halves(const ArcPiece& p) {
  const Vec2 a = (p.p0 + p.p1 * p.w) / (1 + p.w), c = (p.p2 + p.p1 * p.w) / (1 + p.w), m = (a + c) * 0.5;
  const double w = std::sqrt((1 + p.w) / 2);
  return {ArcPiece{p.p0, a, m, w, p.feature}, ArcPiece{m, c, p.p2, w, p.feature}};
}

/// Whether the segment reaches into the convex hull's interior, by more than rounding.
bool reaches(const Hull& hull, Vec2 a, Vec2 b) {
  const std::size_t n = hull.sides();
  Vec2 middle{};
  for (std::size_t k = 0; k < n; ++k) middle = middle + hull.corners[k] / static_cast<double>(n);
  // The part of the segment on the inner side of every side of a hull that is smaller by a millionth.
  double from = 0, to = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 p = hull.corners[k] + (middle - hull.corners[k]) * 1e-6,
               q = hull.corners[(k + 1) % n] + (middle - hull.corners[(k + 1) % n]) * 1e-6;
    const double fa = cross(q - p, a - p), fb = cross(q - p, b - p);
    if (fa <= 0 && fb <= 0) return false;
    if (fa < 0) from = std::max(from, fa / (fa - fb));
    if (fb < 0) to = std::min(to, fa / (fa - fb));
  }
  return from < to;
}

bool overlap(const Hull& a, const Hull& b) {
  const std::size_t n = b.sides();
  for (std::size_t k = 0; k < n; ++k)
    if (reaches(a, b.corners[k], b.corners[(k + 1) % n])) return true;
  // One within the other.
  return reaches(b, a.corners[0], a.corners[1]) || reaches(b, a.corners[1], a.corners[2]);
}

class Decomposition {
 public:
  Decomposition(const PartDps& part, const QuadricDp& dp) : part_(part), dp_(dp) {
    for (const Vec2 c : dp.footprint) box_.add(c);
    extent_ = std::max(box_.size().x, box_.size().y);
  }

  std::vector<RegionCell> run() {
    if (!(box_.size().x > kTiny * extent_ && box_.size().y > kTiny * extent_)) return {};
    take_pieces();
    if (lines_.size() + hulls_.size() > kMostCellPieces || !separate()) return {};
    choose_paths();
    trapezoids();
    for (const Hull& hull : hulls_) add_hull(hull);
    return std::move(cells_);
  }

 private:
  void take_pieces() {
    for (std::uint32_t i = 0; i < dp_.lines; ++i)
      lines_.push_back({part_.lines[dp_.first_line + i].p0, part_.lines[dp_.first_line + i].p1});
    for (std::uint32_t i = 0; i < dp_.arcs; ++i) take_arc(part_.arcs[dp_.first_arc + i], 0);
    for (std::uint32_t i = 0; i < dp_.ellipses; ++i)
      hulls_.push_back(ellipse_hull(part_.ellipses[dp_.first_ellipse + i]));
  }

  void take_arc(const ArcPiece& arc, int halvings) {
    const Vec2 chord = arc.p2 - arc.p0, middle = (arc.p0 + arc.p2) * 0.5;
    const double area = std::abs(cross(arc.p1 - arc.p0, chord)), l = length(chord);
    if (area * arc.w <= kFlat * extent_ * std::max(l, kTiny * extent_) * (1 + arc.w)) {
      lines_.push_back({arc.p0, arc.p2});
    } else if (length(arc.p1 - middle) > kFarPole * l && halvings < kMostHalvings) {
      for (const ArcPiece& half : halves(arc)) take_arc(half, halvings + 1);
    } else {
      hulls_.push_back(arc_hull(arc, halvings));
    }
  }

  /// Makes hulls smaller until none overlaps another or has a straight piece in it.
  bool separate() {
    for (int round = 0; round <= kMostHalvings + 1; ++round) {
      std::vector<bool> bad(hulls_.size(), false);
      bool any = false;
      for (std::size_t i = 0; i < hulls_.size(); ++i) {
        for (const Segment& s : lines_)
          if (reaches(hulls_[i], s.a, s.b)) bad[i] = any = true;
        for (std::size_t k = 0; k < i; ++k)
          if (overlap(hulls_[i], hulls_[k])) bad[i] = bad[k] = any = true;
      }
      if (!any) return true;
      std::vector<Hull> before = std::move(hulls_);
      hulls_.clear();
      for (std::size_t i = 0; i < before.size(); ++i) {
        const Hull& h = before[i];
        if (!bad[i]) {
          hulls_.push_back(h);
        } else if (!h.arc) {
          for (const ArcPiece& arc : arcs_of(h.ellipse)) take_arc(arc, 0);
        } else if (h.halvings >= kMostHalvings) {
          return false;
        } else {
          for (const ArcPiece& half : halves(h.piece)) take_arc(half, h.halvings + 1);
        }
      }
      if (lines_.size() + hulls_.size() > kMostCellPieces) return false;
    }
    return false;
  }

  /// Where the inner side of a conic is inside, the trapezoids end at an arc's chord; else at the hull's
  /// other sides.
  void choose_paths() {
    segments_ = lines_;
    for (Hull& h : hulls_) {
      const bool inside = pieces_contain(part_, dp_, h.inner);
      h.conic.sign = inside ? 1 : -1;
      const std::size_t n = h.sides();
      if (h.arc && inside) segments_.push_back({h.corners[2], h.corners[0]});
      if (!inside)
        for (std::size_t k = 0; k < (h.arc ? 2 : n); ++k)
          segments_.push_back({h.corners[k], h.corners[(k + 1) % n]});
    }
    for (Segment& s : segments_)
      if (s.b.x < s.a.x) std::swap(s.a, s.b);
    std::erase_if(segments_, [&](const Segment& s) {
      return s.b.x < box_.lo.x || s.a.x > box_.hi.x || std::max(s.a.y, s.b.y) < box_.lo.y ||
             std::min(s.a.y, s.b.y) > box_.hi.y;
    });
    piece_segments_ = segments_.size();
    for (std::size_t k = 0; k < 4; ++k) {
      Segment side{dp_.footprint[k], dp_.footprint[(k + 1) % 4]};
      if (side.b.x < side.a.x) std::swap(side.a, side.b);
      segments_.push_back(side);
    }
  }

  /// Where anything begins, ends or meets something else.
  std::vector<double> events() const {
    std::vector<double> x;
    for (const Segment& s : segments_) x.push_back(s.a.x), x.push_back(s.b.x);
    for (std::size_t i = 0; i < segments_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Segment &s = segments_[i], &t = segments_[k];
        if (s.b.x <= t.a.x || t.b.x <= s.a.x) continue;
        const double lo = std::max(s.a.x, t.a.x), hi = std::min(s.b.x, t.b.x);
        const double before = s.at(lo) - t.at(lo), after = s.at(hi) - t.at(hi);
        if ((before < 0) != (after < 0)) x.push_back(lo + (hi - lo) * before / (before - after));
      }
    std::erase_if(x, [&](double v) { return !(v >= box_.lo.x && v <= box_.hi.x); });
    std::sort(x.begin(), x.end());
    const double least = kTiny * extent_;
    x.erase(std::unique(x.begin(), x.end(), [&](double a, double b) { return b - a < least; }), x.end());
    return x;
  }

  struct Trapezoid {
    std::size_t bottom, top;
    double x0, x1;
  };

  void trapezoids() {
    const std::vector<double> x = events();
    std::vector<Trapezoid> open;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      std::vector<Trapezoid> here = slab(x[i], x[i + 1]);
      for (const Trapezoid& before : open) {
        const auto same = std::find_if(here.begin(), here.end(), [&](const Trapezoid& t) {
          return t.bottom == before.bottom && t.top == before.top;
        });
        if (same != here.end()) {
          same->x0 = before.x0;
        } else {
          emit(before);
        }
      }
      open = std::move(here);
    }
    for (const Trapezoid& t : open) emit(t);
  }

  /// From the footprint's lower side upwards; every segment between turns inside and outside round.
  std::vector<Trapezoid> slab(double x0, double x1) const {
    const double x = (x0 + x1) / 2;
    std::vector<std::pair<double, std::size_t>> bounds;
    double low = INFINITY, high = -INFINITY;
    std::size_t bottom = segments_.size(), top = segments_.size();
    for (std::size_t k = piece_segments_; k < segments_.size(); ++k) {
      const Segment& s = segments_[k];
      if (!(s.a.x <= x && x <= s.b.x && s.a.x < s.b.x)) continue;
      const double y = s.at(x);
      if (y < low) low = y, bottom = k;
      if (y > high) high = y, top = k;
    }
    if (!(low < high)) return {};
    for (std::size_t k = 0; k < piece_segments_; ++k) {
      const Segment& s = segments_[k];
      if (!(s.a.x <= x && x <= s.b.x && s.a.x < s.b.x)) continue;
      const double y = s.at(x);
      if (y > low && y < high) bounds.push_back({y, k});
    }
    std::sort(bounds.begin(), bounds.end());
    bounds.insert(bounds.begin(), {low, bottom});
    bounds.push_back({high, top});
    std::vector<Trapezoid> result;
    bool inside = inside_at_bottom(x, bounds);
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k, inside = !inside)
      if (inside) result.push_back({bounds[k].second, bounds[k + 1].second, x0, x1});
    return result;
  }

  /// By the middle of the widest interval. Hulls are cells of their own: to the trapezoids all of them is
  /// outside.
  bool inside_at_bottom(double x, const std::vector<std::pair<double, std::size_t>>& bounds) const {
    std::size_t widest = 0;
    const auto width = [&](std::size_t k) { return bounds[k + 1].first - bounds[k].first; };
    for (std::size_t k = 1; k + 1 < bounds.size(); ++k)
      if (width(k) > width(widest)) widest = k;
    const Vec2 p{x, bounds[widest].first + width(widest) / 2};
    const bool inside = !in_hull(p) && pieces_contain(part_, dp_, p);
    return inside != (widest % 2 == 1);
  }

  bool in_hull(Vec2 p) const {
    return std::any_of(hulls_.begin(), hulls_.end(), [&](const Hull& h) {
      for (std::size_t k = 0; k < h.sides(); ++k)
        if (cross(h.corners[(k + 1) % h.sides()] - h.corners[k], p - h.corners[k]) < 0) return false;
      return true;
    });
  }

  void emit(const Trapezoid& t) {
    const Segment &b = segments_[t.bottom], &u = segments_[t.top];
    const double y00 = b.at(t.x0), y10 = b.at(t.x1), y11 = std::max(u.at(t.x1), y10),
                 y01 = std::max(u.at(t.x0), y00);
    if (std::max(y11 - y10, y01 - y00) <= kTiny * extent_) return;
    cells_.push_back({{Vec2{t.x0, y00}, Vec2{t.x1, y10}, Vec2{t.x1, y11}, Vec2{t.x0, y01}}, std::nullopt});
  }

  /// The footprint's part of a hull, in fans of quadrilaterals.
  void add_hull(const Hull& hull) {
    std::vector<Vec2> polygon(hull.corners.begin(), hull.corners.begin() + static_cast<long>(hull.sides()));
    for (std::size_t k = 0; k < 4 && !polygon.empty(); ++k)
      polygon = clipped(polygon, dp_.footprint[k], dp_.footprint[(k + 1) % 4]);
    for (std::size_t k = 1; k + 1 < polygon.size(); k += 2) {
      const Vec2 last = polygon[std::min(k + 2, polygon.size() - 1)];
      cells_.push_back({{polygon[0], polygon[k], polygon[k + 1], last}, hull.conic});
    }
  }

  static std::vector<Vec2> clipped(const std::vector<Vec2>& polygon, Vec2 a, Vec2 b) {
    if (a.x == b.x && a.y == b.y) return polygon;
    std::vector<Vec2> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double fp = cross(b - a, p - a), fq = cross(b - a, q - a);
      if (fp >= 0) result.push_back(p);
      if ((fp < 0) != (fq < 0)) result.push_back(p + (q - p) * (fp / (fp - fq)));
    }
    return result.size() < 3 ? std::vector<Vec2>{} : result;
  }

  const PartDps& part_;
  const QuadricDp& dp_;
  Box2 box_;
  double extent_ = 0;
  std::vector<Segment> lines_, segments_;
  std::size_t piece_segments_ = 0;  ///< of segments_; then the footprint's sides
  std::vector<Hull> hulls_;
  std::vector<RegionCell> cells_;
};

}  // namespace

std::vector<RegionCell> region_cells(const PartDps& part, const QuadricDp& dp) {
  return Decomposition(part, dp).run();
}

bool cell_contains(const RegionCell& cell, Vec2 p) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = cell.corners[k], b = cell.corners[(k + 1) % 4];
    if (cross(b - a, p - a) < 0) return false;
  }
  if (!cell.conic) return true;
  const ConicTest& t = *cell.conic;
  const double c = t.c.at(p);
  return t.sign * (t.a.at(p) * t.b.at(p) - c * c) >= 0;
}

}  // namespace dupin
