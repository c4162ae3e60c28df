#include "invert.h"

#include <cmath>
#include <numbers>

namespace dupin {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double near(double angle, double guess) {
  return angle + kTurn * std::round((guess - angle) / kTurn);
}

/// atan2 next to the guess; the guess itself where the vector is nothing but rounding of `size`.
double angle_of(double y, double x, double size, double guess) {
  if (std::abs(x) <= 1e-15 * size && std::abs(y) <= 1e-15 * size) return guess;
  return near(std::atan2(y, x), guess);
}

Vec2 closed_form(const Plane& s, const Vec3& p, Vec2) {
  const Vec3 q = s.frame.to_local(p);
  return {q.x, q.y};
}

Vec2 closed_form(const Cylinder& s, const Vec3& p, Vec2 guess) {
  const Vec3 q = s.frame.to_local(p);
  return {angle_of(q.y, q.x, s.radius, guess.x), q.z};
}

Vec2 closed_form(const Cone& s, const Vec3& p, Vec2 guess) {
  const Vec3 q = s.frame.to_local(p);
  const double sine = std::sin(s.half_angle), cosine = std::cos(s.half_angle);
  // Beyond the apex the radius is negative: the generator's other side.
  const double side = s.radius + guess.y * sine < 0 ? -1 : 1;
  const double rho = side * std::hypot(q.x, q.y);
  return {angle_of(side * q.y, side * q.x, std::abs(s.radius) + std::abs(q.z), guess.x),
          (rho - s.radius) * sine + q.z * cosine};
}

Vec2 closed_form(const Sphere& s, const Vec3& p, Vec2 guess) {
  const Vec3 q = s.frame.to_local(p);
  return {angle_of(q.y, q.x, s.radius, guess.x), std::atan2(q.z, std::hypot(q.x, q.y))};
}

Vec2 closed_form(const Torus& s, const Vec3& p, Vec2 guess) {
  const Vec3 q = s.frame.to_local(p);
  // Of a spindle torus the meridian reaches across the axis: its inner part belongs to the opposite azimuth.
  const double side = s.major + s.minor * std::cos(guess.y) < 0 ? -1 : 1;
  const double rho = side * std::hypot(q.x, q.y);
  return {angle_of(side * q.y, side * q.x, s.major + s.minor, guess.x),
          angle_of(q.z, rho - s.major, s.minor, guess.y)};
}

/// Into the domain, but not out of a period.
Vec2 confined(Vec2 q, const Box2& box, bool periodic_u, bool periodic_v) {
  if (!periodic_u) q.x = std::clamp(q.x, box.lo.x, box.hi.x);
  if (!periodic_v) q.y = std::clamp(q.y, box.lo.y, box.hi.y);
  return q;
}

struct Normal2 {
  double a, b, c;  // [a b; b c]
  Vec2 solve(Vec2 g) const {
    const double det = a * c - b * b;
    return {(c * g.x - b * g.y) / det, (a * g.y - b * g.x) / det};
  }
  bool definite() const { return a > 0 && c > 0 && a * c - b * b > 1e-14 * a * c; }
};

class Newton {
 public:
  Newton(const Surface& surface, const Vec3& p)
      : surface_(surface),
        p_(p),
        box_(domain(surface)),
        periodic_u_(period_u(surface) > 0),
        periodic_v_(period_v(surface) > 0) {}

  std::optional<Vec2> run(Vec2 q) const {
    q = confined(q, box_, periodic_u_, periodic_v_);
    SurfaceJet jet = evaluate(surface_, q.x, q.y, 2);
    const auto width = [](double lo, double hi) { return std::isfinite(hi - lo) ? hi - lo : 1; };
    const double size = length(p_) + length(jet.p) + length(jet.pu) * width(box_.lo.x, box_.hi.x) +
                        length(jet.pv) * width(box_.lo.y, box_.hi.y);
    for (int i = 0; i < kInvertSteps; ++i) {
      const Vec2 step = proposal(jet, q);
      if (settled(jet, step, size)) return q;
      double factor = 1;
      const double before = distance(jet.p, p_);
      Vec2 next = q;
      SurfaceJet there;
      for (;; factor *= 0.25) {
        next = confined(q + step * factor, box_, periodic_u_, periodic_v_);
        there = evaluate(surface_, next.x, next.y, 2);
        if (distance(there.p, p_) < before) break;
        if (factor < 1e-6) return stationary(jet, q, size) ? std::optional(q) : std::nullopt;
      }
      q = next;
      jet = there;
    }
    return std::nullopt;
  }

 private:
  /// The Newton step for |S − p|²/2, or Gauss–Newton's where that is no descent; along a border where it
  /// leads out.
  Vec2 proposal(const SurfaceJet& jet, Vec2 q) const {
    const Vec3 r = jet.p - p_;
    Vec2 g{dot(r, jet.pu), dot(r, jet.pv)};
    const bool fixed_u = pinned(q.x, -g.x, box_.lo.x, box_.hi.x, periodic_u_);
    const bool fixed_v = pinned(q.y, -g.y, box_.lo.y, box_.hi.y, periodic_v_);
    const Normal2 gauss{dot(jet.pu, jet.pu), dot(jet.pu, jet.pv), dot(jet.pv, jet.pv)};
    const Normal2 full{gauss.a + dot(r, jet.puu), gauss.b + dot(r, jet.puv), gauss.c + dot(r, jet.pvv)};
    if (fixed_u && fixed_v) return {};
    if (fixed_u) return {0, -g.y / (full.c > 0 ? full.c : gauss.c > 0 ? gauss.c : 1)};
    if (fixed_v) return {-g.x / (full.a > 0 ? full.a : gauss.a > 0 ? gauss.a : 1), 0};
    if (full.definite()) return -full.solve(g);
    if (gauss.definite()) return -gauss.solve(g);
    const double scale = gauss.a + gauss.c;
    return scale > 0 ? g * (-1 / scale) : Vec2{};
  }
  static bool pinned(double t, double way, double lo, double hi, bool periodic) {
    return !periodic && ((t <= lo && way <= 0) || (t >= hi && way >= 0));
  }
  /// A step that moves the point by no more than rounding, at the surface's size.
  bool settled(const SurfaceJet& jet, Vec2 step, double size) const {
    const double moved = length(jet.pu) * std::abs(step.x) + length(jet.pv) * std::abs(step.y);
    return moved <= 4e-16 * size + 1e-15 * distance(jet.p, p_);
  }
  /// No free direction leads nearer: the distance is all rounding, or perpendicular to the surface to half
  /// its digits.
  bool stationary(const SurfaceJet& jet, Vec2 q, double size) const {
    const double away = distance(jet.p, p_);
    return away <= 1e-14 * size || slope(jet, q) <= 1e-7 * away;
  }
  /// The slope of half the squared distance along the free directions, in space.
  double slope(const SurfaceJet& jet, Vec2 q) const {
    const Vec3 r = jet.p - p_;
    const Vec2 g{dot(r, jet.pu), dot(r, jet.pv)};
    const double gu =
        pinned(q.x, -g.x, box_.lo.x, box_.hi.x, periodic_u_) ? 0 : std::abs(g.x) / length(jet.pu);
    const double gv =
        pinned(q.y, -g.y, box_.lo.y, box_.hi.y, periodic_v_) ? 0 : std::abs(g.y) / length(jet.pv);
    return std::max(std::isfinite(gu) ? gu : 0, std::isfinite(gv) ? gv : 0);
  }

  const Surface& surface_;
  Vec3 p_;
  Box2 box_;
  bool periodic_u_, periodic_v_;
};

/// What a sweep's other parameter must be for the guess's point of the profile to come nearest to p.
Vec2 better_guess(const Revolution& s, const Vec3& p, Vec2 guess) {
  const auto across = [&s](const Vec3& q) {
    const Vec3 d = q - s.axis_origin;
    return d - s.axis_direction * dot(d, s.axis_direction);
  };
  const Vec3 from = across(point_at(s.profile, guess.y)), to = across(p);
  const double sine = dot(s.axis_direction, cross(from, to)), cosine = dot(from, to);
  return {angle_of(sine, cosine, dot(from, from) + dot(to, to), guess.x), guess.y};
}
Vec2 better_guess(const Extrusion& s, const Vec3& p, Vec2 guess) {
  return {guess.x, dot(s.direction, p - point_at(s.profile, guess.x))};
}
template <class Other>
Vec2 better_guess(const Other&, const Vec3&, Vec2 guess) {
  return guess;
}

}  // namespace

std::optional<Vec2> invert(const Surface& surface, const Vec3& p, Vec2 guess) {
  return std::visit(
      [&](const auto& geometry) -> std::optional<Vec2> {
        if constexpr (requires { closed_form(geometry, p, guess); })
          return closed_form(geometry, p, guess);
        else
          return Newton(surface, p).run(better_guess(geometry, p, guess));
      },
      surface.geometry);
}

}  // namespace dupin
