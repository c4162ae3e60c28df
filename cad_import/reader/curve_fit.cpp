#include "curve_fit.h"

#include <algorithm>
#include <functional>

namespace dupin::reader {
namespace {

constexpr int kGrid = 16;  // points a side of the search for a projection's beginning
constexpr int kNewtonSteps = 30;
constexpr int kFirstPieces = 8;
constexpr int kMaxDepth = 10;  // halvings of a first piece
constexpr std::size_t kMaxPieces = 600;
constexpr double kShortestStep = 1e-5;  // of a first piece
constexpr int kMaxMarch = 1000;         // steps through one
constexpr int kChecksPerPiece = 3;      // inside each piece

template <class V>
struct Node {
  double t = 0;
  V point{}, tangent{};
};

template <class V>
V hermite(const Node<V>& a, const Node<V>& b, double t) {
  const double h = b.t - a.t, s = (t - a.t) / h, r = 1 - s;
  return a.point * (r * r * (1 + 2 * s)) + b.point * (s * s * (1 + 2 * r)) + a.tangent * (h * s * r * r) -
         b.tangent * (h * r * s * s);
}

template <class V>
BsplineOf<V> to_spline(const std::vector<Node<V>>& nodes) {
  BsplineOf<V> spline;
  spline.degree = 3;
  spline.knots.assign(4, nodes.front().t);
  spline.poles.push_back(nodes.front().point);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Node<V>&a = nodes[i], &b = nodes[i + 1];
    const double third = (b.t - a.t) / 3;
    spline.poles.push_back(a.point + a.tangent * third);
    spline.poles.push_back(b.point - b.tangent * third);
    spline.knots.insert(spline.knots.end(), i + 2 < nodes.size() ? 2 : 4, b.t);
  }
  spline.poles.push_back(nodes.back().point);
  return spline;
}

template <class V>
struct Refinement {
  double tolerance = 0;
  std::function<Node<V>(double, const Node<V>&)> node_at;  ///< the exact node at t, given the one before it
  std::function<double(double, const V&)> error;           ///< how far a point of the cubic is off at t
  std::vector<Node<V>> nodes;

  // Halves [a, b] until the cubic is within the tolerance where it is checked, or no more halving helps;
  // appends b.
  void run(const Node<V>& a, const Node<V>& b, int depth) {
    double worst = 0;
    for (int i = 1; i <= kChecksPerPiece; ++i) {
      const double t = a.t + (b.t - a.t) * i / (kChecksPerPiece + 1);
      worst = std::max(worst, error(t, hermite(a, b, t)));
    }
    if (worst <= tolerance || depth == 0 || nodes.size() >= kMaxPieces || !std::isfinite(worst)) {
      nodes.push_back(b);
      return;
    }
    const Node<V> middle = node_at((a.t + b.t) / 2, a);
    run(a, middle, depth - 1);
    run(middle, b, depth - 1);
  }

  bool finite() const {
    return std::all_of(nodes.begin(), nodes.end(), [](const Node<V>& n) {
      return std::isfinite(dot(n.point, n.point)) && std::isfinite(dot(n.tangent, n.tangent));
    });
  }
};

std::vector<double> first_parameters(std::vector<double> stops, double t0, double t1) {
  stops.insert(stops.begin(), t0);
  stops.push_back(t1);
  std::vector<double> result{t0};
  const double longest = (t1 - t0) / kFirstPieces;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((stops[i + 1] - stops[i]) / longest - 1e-9)));
    for (int k = 1; k <= pieces; ++k) result.push_back(stops[i] + (stops[i + 1] - stops[i]) * k / pieces);
  }
  return result;
}

// d with |Su·d.x + Sv·d.y - w| smallest; the damping keeps it bounded where the partials are parallel or
// vanish.
Vec2 tangent_parameters(const SurfaceJet& s, const Vec3& w) {
  const double e = dot(s.pu, s.pu), f = dot(s.pu, s.pv), g = dot(s.pv, s.pv);
  const double a = e + 1e-14 * g, c = g + 1e-14 * e, det = a * c - f * f;
  if (!(det > 1e-24 * (e + g) * (e + g))) {
    if (e >= g) return e > 0 ? Vec2{dot(s.pu, w) / e, 0} : Vec2{};
    return {0, dot(s.pv, w) / g};
  }
  const double x = dot(s.pu, w), y = dot(s.pv, w);
  return {(c * x - f * y) / det, (a * y - f * x) / det};
}

// At the edge of an open domain, with the way down leading out of it, only the other parameter can move.
bool stuck(double q, double lo, double hi, double period, double gradient) {
  return period == 0 && ((q <= lo && gradient > 0) || (q >= hi && gradient < 0));
}

Vec2 clamp_to(const Surface& surface, const Box2& domain, Vec2 q) {
  if (period_u(surface) == 0) q.x = std::clamp(q.x, domain.lo.x, domain.hi.x);
  if (period_v(surface) == 0) q.y = std::clamp(q.y, domain.lo.y, domain.hi.y);
  return q;
}

// Levenberg's damped Newton steps on |S(u,v) - p|²; every accepted step gets nearer.
Vec2 newton(const Surface& surface, const Box2& domain, const Vec3& p, Vec2 q) {
  double damping = 0;
  SurfaceJet s = evaluate(surface, q.x, q.y, 2);
  double best = distance(s.p, p);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Vec3 r = s.p - p;
    double gu = dot(s.pu, r), gv = dot(s.pv, r);
    double a = dot(s.pu, s.pu), b = dot(s.pu, s.pv), c = dot(s.pv, s.pv);
    const double scale = a + c;
    const double full_a = a + dot(s.puu, r), full_b = b + dot(s.puv, r), full_c = c + dot(s.pvv, r);
    if (full_a > 0 && full_a * full_c - full_b * full_b > 1e-8 * a * c) a = full_a, b = full_b, c = full_c;
    const bool u_stuck = stuck(q.x, domain.lo.x, domain.hi.x, period_u(surface), gu);
    const bool v_stuck = stuck(q.y, domain.lo.y, domain.hi.y, period_v(surface), gv);
    if (u_stuck && v_stuck) break;
    if (u_stuck) gu = 0, b = 0, a = scale;
    if (v_stuck) gv = 0, b = 0, c = scale;
    a += damping * scale, c += damping * scale;
    const double det = a * c - b * b;
    if (!(det > 0)) {
      damping = std::max(1e-12, damping * 10);
      continue;
    }
    const Vec2 next =
        clamp_to(surface, domain, {q.x - (c * gu - b * gv) / det, q.y - (a * gv - b * gu) / det});
    const SurfaceJet moved = evaluate(surface, next.x, next.y, 2);
    const double d = distance(moved.p, p);
    if (!(d <= best)) {
      damping = std::max(1e-6, damping * 10);
      continue;
    }
    const double step = length(next - q), size = 1 + length(q);
    q = next, s = moved, best = d, damping *= 0.1;
    if (step < 1e-15 * size) break;
  }
  return q;
}

// In closed form, with u in (-π, π], for the analytic kinds.
std::optional<Vec2> exact_parameters(const Surface& surface, const Vec3& p) {
  if (const auto* s = std::get_if<Plane>(&surface.geometry)) {
    const Vec3 q = s->frame.to_local(p);
    return Vec2{q.x, q.y};
  }
  if (const auto* s = std::get_if<Cylinder>(&surface.geometry)) {
    const Vec3 q = s->frame.to_local(p);
    return Vec2{std::atan2(q.y, q.x), q.z};
  }
  if (const auto* s = std::get_if<Sphere>(&surface.geometry)) {
    const Vec3 q = s->frame.to_local(p);
    return Vec2{std::atan2(q.y, q.x), std::atan2(q.z, std::hypot(q.x, q.y))};
  }
  if (const auto* s = std::get_if<Torus>(&surface.geometry)) {
    const Vec3 q = s->frame.to_local(p);
    return Vec2{std::atan2(q.y, q.x), std::atan2(q.z, std::hypot(q.x, q.y) - s->major)};
  }
  if (const auto* s = std::get_if<Cone>(&surface.geometry)) {
    const Vec3 q = s->frame.to_local(p);
    const double sine = std::sin(s->half_angle), cosine = std::cos(s->half_angle);
    // Beyond the apex the generator through p is the opposite one.
    const double side = q.z * sine + s->radius * cosine < 0 ? -1 : 1, r = side * std::hypot(q.x, q.y);
    return Vec2{std::atan2(side * q.y, side * q.x), (r - s->radius) * sine + q.z * cosine};
  }
  return std::nullopt;
}

Vec2 nearest_turn(const Surface& surface, Vec2 q, Vec2 near) {
  const double turn_u = period_u(surface), turn_v = period_v(surface);
  if (turn_u > 0) q.x += std::round((near.x - q.x) / turn_u) * turn_u;
  if (turn_v > 0) q.y += std::round((near.y - q.y) / turn_v) * turn_v;
  return q;
}

// Whether a step in parameters is so long that it may have lost a turn.
bool too_far(const Surface& surface, Vec2 step) {
  const double turn_u = period_u(surface), turn_v = period_v(surface);
  return (turn_u > 0 && std::abs(step.x) > turn_u / 6) || (turn_v > 0 && std::abs(step.y) > turn_v / 6);
}

// A space curve as it falls onto a surface.
struct Shadow {
  const Surface& surface;
  const Box2& domain;
  const Curve3& curve;
  double tolerance;

  Node<Vec2> node(double t, const Vec2* near) const {
    const CurveJet<Vec3> c = evaluate(curve, t, 1);
    const Vec2 q = project(surface, domain, c[0], near);
    return {t, q, tangent_parameters(evaluate(surface, q.x, q.y, 1), c[1])};
  }
  Vec2 ahead(const Node<Vec2>& from, double t) const {
    return clamp_to(surface, domain, from.point + from.tangent * (t - from.t));
  }
  double miss(const Node<Vec2>& n) const {
    return distance(point_at(surface, n.point.x, n.point.y), point_at(curve, n.t));
  }

  // Along the surface, from where the point should be. A tenth of the curve's own height above the surface
  // does not matter.
  double error(double t, const Vec2& q) const {
    const Vec3 p = point_at(curve, t), on = point_at(surface, q.x, q.y);
    if (distance(on, p) <= tolerance) return 0;
    const Vec2 foot = project(surface, domain, p, &q);
    const Vec3 nearest = point_at(surface, foot.x, foot.y);
    return distance(on, nearest) - 0.1 * distance(nearest, p);
  }

  // The next node of a march, from the extrapolated point, or from where the march stands if that leads
  // nearer.
  Node<Vec2> follow(const Node<Vec2>& at, double t) const {
    const Vec2 guess = ahead(at, t);
    const Node<Vec2> extrapolated = node(t, &guess);
    const bool jumps = too_far(surface, extrapolated.point - at.point);
    if (!jumps && miss(extrapolated) <= tolerance) return extrapolated;
    const Node<Vec2> stayed = node(t, &at.point);
    return jumps || miss(stayed) < 0.5 * miss(extrapolated) - 1e-12 ? stayed : extrapolated;
  }

  // Small steps, smaller where the parameters move fast, keep to the same turn of a periodic surface.
  Node<Vec2> march(Node<Vec2> at, double to) const {
    const double from = at.t;
    double done = 0, step = 1.0 / 8;
    for (int i = 0; i < kMaxMarch && done < 1; ++i) {
      step = std::min(step, 1 - done);
      const Node<Vec2> next = follow(at, from + (to - from) * (done + step));
      if (too_far(surface, next.point - at.point) && step > kShortestStep) {
        step /= 4;
        continue;
      }
      at = next, done += step, step *= 2;
    }
    return done < 1 ? node(to, &at.point) : at;
  }

  // The middle is the safest place to begin: ends may lie at poles and on seams.
  std::vector<Node<Vec2>> trace(const std::vector<double>& parameters) const {
    std::vector<Node<Vec2>> nodes(parameters.size());
    const std::size_t middle = parameters.size() / 2;
    nodes[middle] = node(parameters[middle], nullptr);
    for (std::size_t i = middle; i + 1 < nodes.size(); ++i) nodes[i + 1] = march(nodes[i], parameters[i + 1]);
    for (std::size_t i = middle; i > 0; --i) nodes[i - 1] = march(nodes[i], parameters[i - 1]);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].t = parameters[i];
    return nodes;
  }
};

}  // namespace

Vec2 project(const Surface& surface, const Box2& domain, const Vec3& p, const Vec2* near) {
  if (const std::optional<Vec2> exact = exact_parameters(surface, p))
    return near ? nearest_turn(surface, *exact, *near) : *exact;
  if (near) return nearest_turn(surface, newton(surface, domain, p, *near), *near);
  Vec2 best = domain.center();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kGrid; ++i)
    for (int j = 0; j <= kGrid; ++j) {
      const Vec2 q = domain.lo + Vec2{domain.size().x * i / kGrid, domain.size().y * j / kGrid};
      const double d = distance(point_at(surface, q.x, q.y), p);
      if (d < least) least = d, best = q;
    }
  return newton(surface, domain, p, best);
}

std::optional<Curve2> fit_pcurve(const Surface& surface, const Box2& domain, const Curve3& curve, double t0,
                                 double t1, double tolerance) {
  const Shadow shadow{surface, domain, curve, tolerance};
  const std::vector<Node<Vec2>> coarse = shadow.trace(first_parameters(breaks(curve, t0, t1, 2), t0, t1));
  Refinement<Vec2> fit;
  fit.tolerance = tolerance;
  fit.error = [&](double t, const Vec2& q) { return shadow.error(t, q); };
  fit.node_at = [&](double t, const Node<Vec2>& before) {
    const Vec2 guess = shadow.ahead(before, t);
    return shadow.node(t, &guess);
  };
  fit.nodes.push_back(coarse.front());
  for (std::size_t i = 0; i + 1 < coarse.size(); ++i) fit.run(coarse[i], coarse[i + 1], kMaxDepth);
  if (!fit.finite()) return std::nullopt;
  return Curve2{to_spline(fit.nodes)};
}

std::optional<Curve3> fit_curve(const Surface& surface, const Curve2& pcurve, double t0, double t1,
                                double tolerance) {
  const auto exact = [&](double t) {
    const CurveJet<Vec2> q = evaluate(pcurve, t, 1);
    const SurfaceJet s = evaluate(surface, q[0].x, q[0].y, 1);
    return Node<Vec3>{t, s.p, s.pu * q[1].x + s.pv * q[1].y};
  };
  Refinement<Vec3> fit;
  fit.tolerance = tolerance;
  fit.node_at = [&](double t, const Node<Vec3>&) { return exact(t); };
  fit.error = [&](double t, const Vec3& p) {
    const Vec2 q = point_at(pcurve, t);
    return distance(point_at(surface, q.x, q.y), p);
  };
  const std::vector<double> parameters = first_parameters(breaks(pcurve, t0, t1, 2), t0, t1);
  fit.nodes.push_back(exact(t0));
  for (std::size_t i = 0; i + 1 < parameters.size(); ++i)
    fit.run(exact(parameters[i]), exact(parameters[i + 1]), kMaxDepth);
  if (!fit.finite()) return std::nullopt;
  return Curve3{to_spline(fit.nodes)};
}

}  // namespace dupin::reader
