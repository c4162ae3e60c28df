#include "conic_arc.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../nurbs/bezier.h"
#include "bernstein.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Arcs turn by at most this much, so that their weights stay well above 0 and a plane cuts them where one
/// expects.
constexpr double kMaxTurn = kPi * 2 / 3 * (1 + 1e-9);
/// Halvings of one Bézier segment before what is left is taken as it is.
constexpr int kMaxDepth = 12;

/// A homogeneous point of the arc.
struct Homogeneous {
  Vec3 p;
  double w;
};
Homogeneous homogeneous(const ConicArc3& arc, double s) {
  const double a = (1 - s) * (1 - s), b = 2 * s * (1 - s) * arc.w, c = s * s;
  return {arc.p0 * a + arc.p1 * b + arc.p2 * c, a + b + c};
}

ConicArc3 line_arc(const Vec3& from, const Vec3& to, double t0, double t1) {
  return {from, (from + to) * 0.5, to, 1, true, t0, t1};
}

/// Circle and ellipse: p(t) = center + cos t·x + sin t·y, as arcs of at most kMaxTurn.
void append_ellipse(const Vec3& center, const Vec3& x, const Vec3& y, double t0, double t1, ArcChain& chain) {
  const int count = std::max(1, static_cast<int>(std::ceil((t1 - t0) / kMaxTurn)));
  auto at = [&](double t) { return center + x * std::cos(t) + y * std::sin(t); };
  for (int i = 0; i < count; ++i) {
    const double a = t0 + (t1 - t0) * i / count, b = i + 1 == count ? t1 : t0 + (t1 - t0) * (i + 1) / count;
    const double half = (b - a) / 2, mid = (a + b) / 2, w = std::cos(half);
    const Vec3 p1 = center + (x * std::cos(mid) + y * std::sin(mid)) / w;
    chain.arcs.push_back({i == 0 ? at(a) : chain.arcs.back().p2, p1, at(b), w, false, a, b});
  }
}

void append_hyperbola(const HyperbolaOf<Vec3>& h, double t0, double t1, ArcChain& chain) {
  const int count = std::max(1, static_cast<int>(std::ceil((t1 - t0) / 2)));
  auto at = [&](double t, double scale) {
    return h.center + (h.x * (h.major * std::cosh(t)) + h.y * (h.minor * std::sinh(t))) * scale;
  };
  for (int i = 0; i < count; ++i) {
    const double a = t0 + (t1 - t0) * i / count, b = i + 1 == count ? t1 : t0 + (t1 - t0) * (i + 1) / count;
    const double w = std::cosh((b - a) / 2);
    chain.arcs.push_back(
        {i == 0 ? at(a, 1) : chain.arcs.back().p2, at((a + b) / 2, 1 / w), at(b, 1), w, false, a, b});
  }
}

/// A polynomial quadratic over [t0, t1] of the curve's own parameter.
struct Quadratic {
  Vec3 p0, p1, p2;
  double t0, t1;
  Vec3 blossom(double a, double b) const {
    const double x = (a - t0) / (t1 - t0), y = (b - t0) / (t1 - t0);
    return p0 * ((1 - x) * (1 - y)) + p1 * (x * (1 - y) + y * (1 - x)) + p2 * (x * y);
  }
};

Vec3 dehomogenised(const Vec4& p) {
  return Vec3{p.x, p.y, p.z} / p.w;
}

/// Largest |C(t) − q(t)| over the segment, from the Bernstein coefficients of N − w·q, divided by the least
/// w.
double difference_bound(const BezierCurve3& curve, const Quadratic& q) {
  const Vec3 b[3] = {q.blossom(curve.t0, curve.t0), q.blossom(curve.t0, curve.t1),
                     q.blossom(curve.t1, curve.t1)};
  const int p = curve.degree, n = p + 2;
  const auto bin_p = bernstein::binomials(p), bin_n = bernstein::binomials(n);
  double largest = 0, least_weight = curve.poles[0].w;
  for (const Vec4& pole : curve.poles) least_weight = std::min(least_weight, pole.w);
  for (int k = 0; k <= n; ++k) {
    Vec3 d{};
    for (int j = 0; j <= 2; ++j) {
      const int i = k - j;
      if (i < 0 || i > p) continue;
      const Vec4& c = curve.poles[static_cast<std::size_t>(i)];
      const double f = bin_p[i] * (j == 1 ? 2 : 1) / bin_n[k];
      d += (Vec3{c.x, c.y, c.z} - b[j] * c.w) * f;
    }
    largest = std::max(largest, length(d));
  }
  return least_weight > 0 ? largest / least_weight : std::numeric_limits<double>::infinity();
}

/// Largest distance of the segment's poles from the chord a–b (bounds the curve's by the convex hull
/// property).
double distance_from_chord(const BezierCurve3& curve, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = dot(d, d);
  double largest = 0;
  for (const Vec4& pole : curve.poles) {
    if (!(pole.w > 0)) return std::numeric_limits<double>::infinity();
    const Vec3 p = dehomogenised(pole) - a;
    const double s = dd > 0 ? std::clamp(dot(p, d) / dd, 0.0, 1.0) : 0;
    largest = std::max(largest, length(p - d * s));
  }
  return largest;
}

Vec3 curve_point(const BezierCurve3& curve, double s) {
  std::array<Vec4, 32> p;
  std::copy(curve.poles.begin(), curve.poles.end(), p.begin());
  for (int k = curve.degree; k > 0; --k)
    for (int i = 0; i < k; ++i)
      p[i] = {p[i].x + (p[i + 1].x - p[i].x) * s, p[i].y + (p[i + 1].y - p[i].y) * s,
              p[i].z + (p[i + 1].z - p[i].z) * s, p[i].w + (p[i + 1].w - p[i].w) * s};
  return dehomogenised(p[0]);
}

std::array<BezierCurve3, 2> halves(const BezierCurve3& curve) {
  std::array<BezierCurve3, 2> r{curve, curve};
  const int n = curve.degree;
  r[0].t1 = r[1].t0 = (curve.t0 + curve.t1) / 2;
  std::vector<Vec4> p = curve.poles;
  for (int k = 0; k <= n; ++k) {
    r[0].poles[static_cast<std::size_t>(k)] = p[0];
    r[1].poles[static_cast<std::size_t>(n - k)] = p[static_cast<std::size_t>(n - k)];
    for (int i = 0; i < n - k; ++i)
      p[i] = {(p[i].x + p[i + 1].x) / 2, (p[i].y + p[i + 1].y) / 2, (p[i].z + p[i + 1].z) / 2,
              (p[i].w + p[i + 1].w) / 2};
  }
  return r;
}

Box3 poles_box(const BezierCurve3& curve) {
  Box3 box;
  for (const Vec4& pole : curve.poles) box.add(dehomogenised(pole));
  return box;
}

/// The quadratic segment itself, its end weights brought to 1 (a reparametrisation that moves no point).
bool exact_conic(const BezierCurve3& curve, ConicArc3& arc) {
  if (curve.degree != 2) return false;
  const Vec4 &a = curve.poles[0], &b = curve.poles[1], &c = curve.poles[2];
  if (!(a.w > 0 && c.w > 0 && b.w > 0)) return false;
  arc = {dehomogenised(a), dehomogenised(b), dehomogenised(c), b.w / std::sqrt(a.w * c.w), false,
         curve.t0,         curve.t1};
  return true;
}

/// Consecutive Bézier segments as few arcs as the tolerance allows: all of them by one line or one quadratic,
/// else each half.
class SplineFitter {
 public:
  SplineFitter(const LocalTolerance& tolerance, ArcChain& chain) : tolerance_(tolerance), chain_(chain) {}

  void fit(std::span<const BezierCurve3> segments, int depth) {
    Box3 box;
    for (const BezierCurve3& s : segments) box.add(poles_box(s));
    const double tolerance = tolerance_(box);
    const Vec3 p0 = dehomogenised(segments.front().poles.front()),
               p2 = dehomogenised(segments.back().poles.back());
    const double t0 = segments.front().t0, t1 = segments.back().t1;
    double line = 0;
    for (const BezierCurve3& s : segments) line = std::max(line, distance_from_chord(s, p0, p2));
    if (line <= std::max(tolerance * 0.1, box.diagonal() * 1e-9) ||
        (line <= tolerance && std::isinf(tolerance)))
      return push(line_arc(p0, p2, t0, t1), std::isinf(tolerance) ? 0 : line);
    ConicArc3 conic;
    if (segments.size() == 1 && exact_conic(segments[0], conic)) return push(conic, 0);
    if (segments.size() == 1 && depth >= kMaxDepth) return push(line_arc(p0, p2, t0, t1), line);
    const double middle = (t0 + t1) / 2;
    const Vec3 m = point_on(segments, middle);
    const Quadratic q{p0, m * 2 - (p0 + p2) * 0.5, p2, t0, t1};
    double deviation = 0;
    for (const BezierCurve3& s : segments) {
      deviation = std::max(deviation, difference_bound(s, q));
      if (deviation > tolerance) break;
    }
    if (deviation <= tolerance)
      return push({p0, q.p1, p2, 1, false, t0, t1}, std::isinf(tolerance) ? 0 : deviation);
    split(segments, depth);
  }

 private:
  void push(const ConicArc3& arc, double deviation) {
    chain_.arcs.push_back(arc);
    chain_.arcs.back().deviation = deviation;
    if (chain_.arcs.size() > 1) chain_.arcs.back().p0 = chain_.arcs[chain_.arcs.size() - 2].p2;
    chain_.deviation = std::max(chain_.deviation, deviation);
  }
  void split(std::span<const BezierCurve3> segments, int depth) {
    if (segments.size() > 1) {
      const std::size_t half = segments.size() / 2;
      fit(segments.first(half), depth);
      fit(segments.subspan(half), depth);
      return;
    }
    const auto parts = halves(segments[0]);
    fit({&parts[0], 1}, depth + 1);
    fit({&parts[1], 1}, depth + 1);
  }
  static Vec3 point_on(std::span<const BezierCurve3> segments, double t) {
    for (const BezierCurve3& s : segments)
      if (t <= s.t1) return curve_point(s, (t - s.t0) / (s.t1 - s.t0));
    return curve_point(segments.back(), 1);
  }
  const LocalTolerance& tolerance_;
  ArcChain& chain_;
};

/// Anything else: quadratics through three points, checked at five more.
void append_sampled(const Curve3& curve, double t0, double t1, const LocalTolerance& tolerance, int depth,
                    ArcChain& chain) {
  const double middle = (t0 + t1) / 2;
  const Vec3 p0 = point_at(curve, t0), m = point_at(curve, middle), p2 = point_at(curve, t1);
  const Quadratic q{p0, m * 2 - (p0 + p2) * 0.5, p2, t0, t1};
  Box3 box;
  double deviation = 0;
  for (int i = 0; i <= 8; ++i) {
    const double t = t0 + (t1 - t0) * i / 8;
    const Vec3 p = point_at(curve, t);
    box.add(p);
    deviation = std::max(deviation, distance(p, q.blossom(t, t)));
  }
  // The largest of seven samples of a cubic error is at least 0.9 of the largest.
  const double allowed = tolerance(box);
  if (deviation * 1.25 <= allowed || depth >= kMaxDepth) {
    chain.arcs.push_back({chain.arcs.empty() ? p0 : chain.arcs.back().p2, q.p1, p2, 1, false, t0, t1,
                          std::isinf(allowed) ? 0 : deviation * 1.25});
    chain.deviation = std::max(chain.deviation, chain.arcs.back().deviation);
    return;
  }
  append_sampled(curve, t0, middle, tolerance, depth + 1, chain);
  append_sampled(curve, middle, t1, tolerance, depth + 1, chain);
}

/// Roots in (0,1) of the quadratic with Bernstein coefficients f0, f1, f2, ascending.
int roots_inside(double f0, double f1, double f2, double roots[2]) {
  const double a = f0 - 2 * f1 + f2, b = 2 * (f1 - f0), c = f0;
  const double disc = b * b - 4 * a * c;
  if (!(disc >= 0)) return 0;
  const double q = -0.5 * (b + std::copysign(std::sqrt(disc), b));
  int count = 0;
  if (a != 0 && q / a > 0 && q / a < 1) roots[count++] = q / a;
  if (q != 0 && c / q > 0 && c / q < 1) roots[count++] = c / q;
  if (count == 2 && roots[0] > roots[1]) std::swap(roots[0], roots[1]);
  return count;
}

}  // namespace

Vec3 point_at(const ConicArc3& arc, double s) {
  if (arc.line) return arc.p0 + (arc.p2 - arc.p0) * s;
  const Homogeneous h = homogeneous(arc, s);
  return h.p / h.w;
}

ConicArc3 sub_arc(const ConicArc3& arc, double s0, double s1) {
  if (arc.line)
    return line_arc(s0 == 0 ? arc.p0 : point_at(arc, s0), s1 == 1 ? arc.p2 : point_at(arc, s1), arc.t0,
                    arc.t1);
  const Homogeneous a = homogeneous(arc, s0), c = homogeneous(arc, s1);
  const double m0 = (1 - s0) * (1 - s1), m1 = s0 * (1 - s1) + s1 * (1 - s0), m2 = s0 * s1;
  const Vec3 b = arc.p0 * m0 + arc.p1 * (m1 * arc.w) + arc.p2 * m2;
  const double bw = m0 + m1 * arc.w + m2;
  return {s0 == 0 ? arc.p0 : a.p / a.w,
          b / bw,
          s1 == 1 ? arc.p2 : c.p / c.w,
          bw / std::sqrt(a.w * c.w),
          false,
          arc.t0,
          arc.t1,
          arc.deviation};
}

Box3 bounding_box(const ConicArc3& arc) {
  Box3 box;
  box.add(arc.p0), box.add(arc.p2);
  if (arc.line) return box;
  // The arc turns by less than a half turn: it stays within the triangle, and for w <= 1 much closer to the
  // chord.
  const Vec3 chord_mid = (arc.p0 + arc.p2) * 0.5,
             shoulder = chord_mid + (arc.p1 - chord_mid) * (arc.w / (1 + arc.w));
  box.add(arc.p0 + (shoulder - chord_mid)), box.add(arc.p2 + (shoulder - chord_mid));
  return box;
}

void clip_to_half_space(const ConicArc3& arc, const Vec3& n, double d, std::vector<ConicArc3>& out) {
  const double f0 = dot(n, arc.p0) + d, f2 = dot(n, arc.p2) + d;
  const double w = arc.line ? 1 : arc.w, f1 = arc.line ? (f0 + f2) / 2 : (dot(n, arc.p1) + d) * w;
  if (f0 >= 0 && f1 >= 0 && f2 >= 0) return out.push_back(arc);
  if (f0 < 0 && f1 < 0 && f2 < 0) return;
  double cut[4] = {0, 0, 0, 0};
  const int count = roots_inside(f0, f1, f2, cut + 1);
  cut[count + 1] = 1;
  for (int i = 0; i <= count; ++i) {
    const double m = (cut[i] + cut[i + 1]) / 2;
    const double f = f0 * (1 - m) * (1 - m) + 2 * f1 * m * (1 - m) + f2 * m * m;
    if (f >= 0) out.push_back(sub_arc(arc, cut[i], cut[i + 1]));
  }
}

ArcChain approximate_edge(const Edge& edge, const LocalTolerance& tolerance) {
  ArcChain chain;
  if (!edge.curve) return chain;
  const auto& g = edge.curve->geometry;
  if (const auto* line = std::get_if<LineOf<Vec3>>(&g)) {
    chain.arcs.push_back(line_arc(line->origin + line->direction * edge.t0,
                                  line->origin + line->direction * edge.t1, edge.t0, edge.t1));
  } else if (const auto* circle = std::get_if<CircleOf<Vec3>>(&g)) {
    append_ellipse(circle->center, circle->x * circle->radius, circle->y * circle->radius, edge.t0, edge.t1,
                   chain);
  } else if (const auto* ellipse = std::get_if<EllipseOf<Vec3>>(&g)) {
    append_ellipse(ellipse->center, ellipse->x * ellipse->major, ellipse->y * ellipse->minor, edge.t0,
                   edge.t1, chain);
  } else if (const auto* h = std::get_if<HyperbolaOf<Vec3>>(&g)) {
    append_hyperbola(*h, edge.t0, edge.t1, chain);
  } else if (const auto* p = std::get_if<ParabolaOf<Vec3>>(&g)) {
    auto blossom = [&](double a, double b) {
      return p->vertex + p->x * (a * b / (4 * p->focal)) + p->y * ((a + b) / 2);
    };
    chain.arcs.push_back({blossom(edge.t0, edge.t0), blossom(edge.t0, edge.t1), blossom(edge.t1, edge.t1), 1,
                          false, edge.t0, edge.t1});
  } else if (const auto segments = bezier_curves(*edge.curve, edge.t0, edge.t1); !segments.empty()) {
    SplineFitter(tolerance, chain).fit(segments, 0);
  } else {
    append_sampled(*edge.curve, edge.t0, edge.t1, tolerance, 0, chain);
  }
  return chain;
}

}  // namespace dupin
