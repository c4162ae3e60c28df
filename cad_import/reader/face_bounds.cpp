#include "face_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "extrema.h"

namespace dupin::reader {
namespace {

struct Range {
  double lo, hi;
};
Range operator+(Range a, Range b) { return {a.lo + b.lo, a.hi + b.hi}; }
Range scaled(Range a, double s) { return s >= 0 ? Range{a.lo * s, a.hi * s} : Range{a.hi * s, a.lo * s}; }
Range join(Range a, Range b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

// Of a·cos t + b·sin t over [t0, t1].
Range wave(double a, double b, double t0, double t1) {
  const auto f = [&](double t) { return a * std::cos(t) + b * std::sin(t); };
  Range r = join({f(t0), f(t0)}, {f(t1), f(t1)});
  constexpr double kTurn = 2 * std::numbers::pi;
  const double amplitude = std::hypot(a, b), top = std::atan2(b, a);
  const auto passes = [&](double t) { return t + std::ceil((t0 - t) / kTurn) * kTurn <= t1; };
  if (passes(top)) r.hi = amplitude;
  if (passes(top + std::numbers::pi)) r.lo = -amplitude;
  return r;
}

template <class F>
Box3 by_axis(F&& range) {
  Box3 box;
  for (int k = 0; k < 3; ++k) {
    const Range r = range(k);
    box.lo[k] = r.lo, box.hi[k] = r.hi;
  }
  return box;
}

Box3 bounds(const Plane& s, const Box2& uv) {
  Box3 box;
  for (const double u : {uv.lo.x, uv.hi.x})
    for (const double v : {uv.lo.y, uv.hi.y}) box.add(s.frame.origin + s.frame.x * u + s.frame.y * v);
  return box;
}

Box3 bounds(const Cylinder& s, const Box2& uv) {
  return by_axis([&](int k) {
    return scaled(wave(s.frame.x[k], s.frame.y[k], uv.lo.x, uv.hi.x), s.radius) +
           scaled({uv.lo.y, uv.hi.y}, s.frame.z[k]) + Range{s.frame.origin[k], s.frame.origin[k]};
  });
}

Box3 bounds(const Cone& s, const Box2& uv) {
  return by_axis([&](int k) {
    const Range c = wave(s.frame.x[k], s.frame.y[k], uv.lo.x, uv.hi.x);
    const auto ring = [&](double v) {
      const double h = s.frame.origin[k] + v * std::cos(s.half_angle) * s.frame.z[k];
      return scaled(c, s.radius + v * std::sin(s.half_angle)) + Range{h, h};
    };
    return join(ring(uv.lo.y), ring(uv.hi.y));  // linear in v
  });
}

// (R + r cos v)·c(u) + r sin v·Z: linear in c, so its extrema lie at those of c.
Box3 ring_bounds(const Frame3& frame, double major, double minor, const Box2& uv) {
  return by_axis([&](int k) {
    const Range c = wave(frame.x[k], frame.y[k], uv.lo.x, uv.hi.x);
    const auto arc = [&](double at) {
      const Range w = scaled(wave(at, frame.z[k], uv.lo.y, uv.hi.y), minor);
      const double h = frame.origin[k] + major * at;
      return w + Range{h, h};
    };
    return join(arc(c.lo), arc(c.hi));
  });
}
Box3 bounds(const Sphere& s, const Box2& uv) { return ring_bounds(s.frame, 0, s.radius, uv); }
Box3 bounds(const Torus& s, const Box2& uv) { return ring_bounds(s.frame, s.major, s.minor, uv); }

// The poles that have a say over [lo, hi].
std::pair<int, int> active(const std::vector<double>& knots, int degree, int count, bool periodic, double lo,
                           double hi) {
  if (periodic) return {0, count - 1};
  const auto span = [&](double t) {
    return std::clamp<int>(static_cast<int>(std::upper_bound(knots.begin(), knots.end(), t) - knots.begin()) - 1,
                           degree, count - 1);
  };
  return {span(lo) - degree, span(hi)};
}

// Convex hull property; weights are positive.
Box3 bounds(const BsplineSurface& s, const Box2& uv) {
  const auto [i0, i1] = active(s.knots_u, s.degree_u, s.count_u, s.periodic_u, uv.lo.x, uv.hi.x);
  const auto [j0, j1] = active(s.knots_v, s.degree_v, s.count_v, s.periodic_v, uv.lo.y, uv.hi.y);
  Box3 box;
  for (int i = i0; i <= i1; ++i)
    for (int j = j0; j <= j1; ++j) box.add(s.poles[static_cast<std::size_t>(i) * s.count_v + j]);
  return box;
}

Box3 bounds(const Revolution& s, const Box2& uv) {
  const Box3 profile = curve_bounds(s.profile, uv.lo.y, uv.hi.y);
  Range height{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  double radius = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = profile.corner(i) - s.axis_origin;
    const double h = dot(d, s.axis_direction);
    height = join(height, {h, h});
    radius = std::max(radius, length(d - s.axis_direction * h));
  }
  return by_axis([&](int k) {
    const double across = radius * std::sqrt(std::max(0.0, 1 - s.axis_direction[k] * s.axis_direction[k]));
    return scaled(height, s.axis_direction[k]) + Range{s.axis_origin[k] - across, s.axis_origin[k] + across};
  });
}

Box3 bounds(const Extrusion& s, const Box2& uv) {
  const Box3 profile = curve_bounds(s.profile, uv.lo.x, uv.hi.x);
  Box3 box;
  for (const double v : {uv.lo.y, uv.hi.y}) {
    box.add(profile.lo + s.direction * v);
    box.add(profile.hi + s.direction * v);
  }
  return box;
}

Box3 bounds(const OffsetSurface& s, const Box2& uv) {
  Box3 box = surface_bounds(*s.base, uv);
  const Vec3 d = Vec3{1, 1, 1} * std::abs(s.distance);
  box.lo -= d, box.hi += d;
  return box;
}

}  // namespace

Box3 curve_bounds(const Curve3& curve, double t0, double t1) {
  Box3 box;
  for_each_extremum<3>(curve, t0, t1, [&](const Vec3& p) { box.add(p); });
  return box;
}

Box3 surface_bounds(const Surface& surface, const Box2& uv) {
  return std::visit([&](const auto& s) { return bounds(s, uv); }, surface.geometry);
}

Box3 face_bounds(const Part& part, const Face& face) {
  const Surface& surface = part.surfaces[face.surface];
  if (!std::holds_alternative<Plane>(surface.geometry) || face.loops.empty())
    return surface_bounds(surface, face.uv_box);
  Box3 box;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      if (edge.curve) box.add(curve_bounds(*edge.curve, edge.t0, edge.t1));
    }
  return box;
}

}  // namespace dupin::reader
