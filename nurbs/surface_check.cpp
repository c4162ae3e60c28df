// What a curve or surface must be before anything computes with it. Whoever makes one checks it once; nothing
// that takes one checks again.
#include <cmath>
#include <sstream>

#include "knots.h"
#include "surface.h"

namespace dupin {
namespace {

/// Frames and directions may be this far from orthonormal.
constexpr double kOrthonormal = 1e-6;
constexpr int kDeepestOffset = 3;  ///< an offset of offsets of …

/// Why something is not valid; empty if it is.
using Reason = std::string;

bool usable(double x) {
  return std::abs(x) <= kMaxCoordinate;  // false for NaN
}
bool usable(const Vec2& p) {
  return usable(p.x) && usable(p.y);
}
bool usable(const Vec3& p) {
  return usable(p.x) && usable(p.y) && usable(p.z);
}
double norm(const Vec2& p) {
  return std::hypot(p.x, p.y);
}
double norm(const Vec3& p) {
  return length(p);
}

std::string text(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}
std::string text(const Vec2& p) {
  return "(" + text(p.x) + ", " + text(p.y) + ")";
}
std::string text(const Vec3& p) {
  return "(" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) + ")";
}
std::string number(std::size_t i) {
  return std::to_string(i);
}

template <class V>
bool orthonormal(const V& x, const V& y) {
  return std::abs(norm(x) - 1) < kOrthonormal && std::abs(norm(y) - 1) < kOrthonormal &&
         std::abs(dot(x, y)) < kOrthonormal;
}

Reason check_knots(const std::vector<double>& knots, int degree, std::size_t poles) {
  if (degree < 1 || degree > kMaxDegree)
    return "a spline's degree " + std::to_string(degree) + " is out of range (1 to " +
           std::to_string(kMaxDegree) + ")";
  const std::size_t order = static_cast<std::size_t>(degree) + 1;
  if (poles < order)
    return "a spline has too few poles (" + number(poles) + " for degree " + std::to_string(degree) + ")";
  if (knots.size() != poles + order)
    return "a spline has a wrong number of knots (" + number(knots.size()) + ", not " +
           number(poles + order) + ")";
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!usable(knots[i]))
      return "a spline's knots are not finite: knot " + number(i) + " is " + text(knots[i]);
    if (i > 0 && knots[i] < knots[i - 1])
      return "a spline's knots decrease: knot " + number(i) + " is " + text(knots[i]) + " after " +
             text(knots[i - 1]);
  }
  if (!(knots[order - 1] < knots[poles]))
    return "a spline's domain is empty: all of it is " + text(knots[poles]);
  return {};
}

template <class V>
Reason check_poles(const std::vector<V>& poles, const std::vector<double>& weights) {
  for (std::size_t i = 0; i < poles.size(); ++i)
    if (!usable(poles[i]))
      return "a pole is not finite or too large: pole " + number(i) + " is " + text(poles[i]);
  if (!weights.empty() && weights.size() != poles.size())
    return "a spline has a wrong number of weights (" + number(weights.size()) + " for " +
           number(poles.size()) + " poles)";
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] >= 1 / kMaxWeight && weights[i] <= kMaxWeight))
      return "a weight is not positive or too large: weight " + number(i) + " is " + text(weights[i]);
  return {};
}

template <class V>
Reason check_curve(const CurveOf<V>& curve, int depth = 0);

template <class V>
struct CurveChecker {
  int depth;

  Reason conic(const V& center, const V& x, const V& y, double a, double b) const {
    if (!usable(center) || !orthonormal(x, y)) return "a conic's axes are not perpendicular unit vectors";
    for (double radius : {a, b})
      if (!(radius > 0) || !usable(radius)) return "a conic's radius is not positive: " + text(radius);
    return {};
  }
  Reason operator()(const LineOf<V>& l) const {
    return usable(l.origin) && usable(l.direction) && norm(l.direction) > 0 ? "" : "a line has no direction";
  }
  Reason operator()(const CircleOf<V>& c) const { return conic(c.center, c.x, c.y, c.radius, c.radius); }
  Reason operator()(const EllipseOf<V>& e) const { return conic(e.center, e.x, e.y, e.major, e.minor); }
  Reason operator()(const ParabolaOf<V>& p) const { return conic(p.vertex, p.x, p.y, p.focal, p.focal); }
  Reason operator()(const HyperbolaOf<V>& h) const { return conic(h.center, h.x, h.y, h.major, h.minor); }
  Reason operator()(const BsplineOf<V>& s) const {
    if (Reason reason = check_knots(s.knots, s.degree, s.poles.size()); !reason.empty()) return reason;
    return check_poles(s.poles, s.weights);
  }
  Reason operator()(const OffsetCurveOf<V>& o) const {
    if (!o.base || depth >= kDeepestOffset) return "an offset curve has no base";
    if (!usable(o.distance) || !usable(o.reference)) return "an offset curve's distance is not finite";
    return check_curve(*o.base, depth + 1);
  }
};

template <class V>
Reason check_curve(const CurveOf<V>& curve, int depth) {
  return std::visit(CurveChecker<V>{depth}, curve.geometry);
}

Reason check_surface(const Surface& surface, int depth);

struct SurfaceChecker {
  int depth;

  Reason frame(const Frame3& f) const {
    if (!usable(f.origin) || !orthonormal(f.x, f.y) || !orthonormal(f.y, f.z) || !orthonormal(f.z, f.x))
      return "a surface's frame is not orthonormal";
    return {};
  }
  Reason frame_and_radius(const Frame3& f, double radius) const {
    if (Reason reason = frame(f); !reason.empty()) return reason;
    return usable(radius) && radius > 0 ? "" : "a surface's radius is not positive: " + text(radius);
  }
  Reason operator()(const Plane& p) const { return frame(p.frame); }
  Reason operator()(const Cylinder& c) const { return frame_and_radius(c.frame, c.radius); }
  Reason operator()(const Cone& c) const {
    if (!usable(c.radius) || c.radius < 0) return "a cone's radius is negative: " + text(c.radius);
    if (!(std::abs(c.half_angle) < 1.5707963267948967) || c.half_angle == 0)
      return "a cone's angle is out of range: " + text(c.half_angle);
    return frame(c.frame);
  }
  Reason operator()(const Sphere& s) const { return frame_and_radius(s.frame, s.radius); }
  Reason operator()(const Torus& t) const {
    if (!usable(t.major) || t.major < 0) return "a torus's major radius is negative: " + text(t.major);
    return frame_and_radius(t.frame, t.minor);
  }
  Reason operator()(const BsplineSurface& s) const {
    if (s.count_u < 2 || s.count_v < 2)
      return "a spline surface has too few poles (" + std::to_string(s.count_u) + " by " +
             std::to_string(s.count_v) + ")";
    const std::size_t count_u = static_cast<std::size_t>(s.count_u),
                      count_v = static_cast<std::size_t>(s.count_v);
    if (Reason reason = check_knots(s.knots_u, s.degree_u, count_u); !reason.empty())
      return std::string("in u ").append(reason);
    if (Reason reason = check_knots(s.knots_v, s.degree_v, count_v); !reason.empty())
      return std::string("in v ").append(reason);
    if (s.poles.size() != count_u * count_v)
      return "a spline surface has a wrong number of poles (" + number(s.poles.size()) + ", not " +
             number(count_u) + " by " + number(count_v) + ")";
    return check_poles(s.poles, s.weights);
  }
  Reason operator()(const Revolution& r) const {
    if (!usable(r.axis_origin) || !(std::abs(length(r.axis_direction) - 1) < kOrthonormal))
      return "a revolution's axis is not a unit vector";
    return check_curve(r.profile);
  }
  Reason operator()(const Extrusion& e) const {
    if (!(std::abs(length(e.direction) - 1) < kOrthonormal))
      return "an extrusion's direction is not a unit vector";
    return check_curve(e.profile);
  }
  Reason operator()(const OffsetSurface& o) const {
    if (!o.base || depth >= kDeepestOffset) return "an offset surface has no base";
    return usable(o.distance) ? check_surface(*o.base, depth + 1)
                              : "an offset surface's distance is not finite";
  }
};

Reason check_surface(const Surface& surface, int depth) {
  return std::visit(SurfaceChecker{depth}, surface.geometry);
}

Status status(Reason reason) {
  if (reason.empty()) return {};
  return {StatusCode::invalid_argument, std::move(reason)};
}

}  // namespace

Status check(const Surface& surface) {
  return status(check_surface(surface, 0));
}
Status check(const Curve2& curve) {
  return status(check_curve(curve));
}
Status check(const Curve3& curve) {
  return status(check_curve(curve));
}

}  // namespace dupin
