#include "face_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "extrema.h"
#include "region_grid.h"

namespace dupin::reader {
namespace {

struct Range {
  double lo, hi;
};
Range operator+(Range a, Range b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
Range scaled(Range a, double s) {
  return s >= 0 ? Range{a.lo * s, a.hi * s} : Range{a.hi * s, a.lo * s};
}
Range join(Range a, Range b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

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
Box3 bounds(const Sphere& s, const Box2& uv) {
  return ring_bounds(s.frame, 0, s.radius, uv);
}
Box3 bounds(const Torus& s, const Box2& uv) {
  return ring_bounds(s.frame, s.major, s.minor, uv);
}

// The poles that have a say over [lo, hi].
std::pair<int, int> active(const std::vector<double>& knots, int degree, int count, bool periodic, double lo,
                           double hi) {
  if (periodic) return {0, count - 1};
  const auto span = [&](double t) {
    return std::clamp<int>(
        static_cast<int>(std::upper_bound(knots.begin(), knots.end(), t) - knots.begin()) - 1, degree,
        count - 1);
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

namespace {

// On ruled surfaces, and planes, the face's extrema lie on its boundary: along a ruling a coordinate is
// linear.
bool is_ruled(const Surface& surface) {
  return std::holds_alternative<Plane>(surface.geometry) ||
         std::holds_alternative<Cylinder>(surface.geometry) ||
         std::holds_alternative<Cone>(surface.geometry) ||
         std::holds_alternative<Extrusion>(surface.geometry);
}

Box3 boundary_bounds(const Part& part, const Face& face, const std::vector<Box3>& edge_boxes) {
  Box3 box;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      box.add(edge_boxes[trim.edge]);
      if (!trim.degenerate) continue;
      const Edge& edge = part.edges[trim.edge];
      for (const double t : {edge.t0, edge.t1}) {
        const Vec2 q = point_at(trim.pcurve, t);
        box.add(point_at(part.surfaces[face.surface], q.x, q.y));
      }
    }
  return box;
}

// The points of a sphere or torus whose normal is along an axis, where the parameter box has them.
void add_poles(const Frame3& frame, const Surface& surface, const Box2& uv, Box3& box) {
  constexpr double kPi = std::numbers::pi;
  const auto into = [](double t, double lo) { return t + std::ceil((lo - t) / (2 * kPi)) * 2 * kPi; };
  for (int k = 0; k < 3; ++k) {
    const double turn = std::atan2(frame.y[k], frame.x[k]),
                 rise = std::asin(std::clamp(frame.z[k], -1.0, 1.0));
    for (const double u : {into(turn, uv.lo.x), into(turn + kPi, uv.lo.x)})
      for (const double v0 : {rise, -rise, kPi - rise, kPi + rise}) {
        const double v = into(v0, uv.lo.y);
        if (u <= uv.hi.x && v <= uv.hi.y) box.add(point_at(surface, u, v));
      }
  }
}

int cells_along(const Surface& surface, bool in_u, double lo, double hi) {
  int cells = 16;
  if (const auto* spline = std::get_if<BsplineSurface>(&surface.geometry)) {
    const auto& knots = in_u ? spline->knots_u : spline->knots_v;
    cells =
        2 * static_cast<int>(
                std::count_if(knots.begin(), knots.end(), [&](double k) { return k > lo && k < hi; }) + 1);
  }
  return std::clamp(cells, 16, 64);
}

// Corners of the cells that the face touches, widened by what the surface can rise between them.
Box3 sampled_bounds(const Part& part, const Face& face) {
  const Surface& surface = part.surfaces[face.surface];
  const Box2& uv = face.uv_box;
  const RegionGrid grid(part, face, cells_along(surface, true, uv.lo.x, uv.hi.x),
                        cells_along(surface, false, uv.lo.y, uv.hi.y));
  const double hu = uv.size().x / grid.cells_u(), hv = uv.size().y / grid.cells_v();
  Box3 box;
  double rise = 0;
  for (int i = 0; i <= grid.cells_u(); ++i)
    for (int j = 0; j <= grid.cells_v(); ++j) {
      const auto touched = [&](int a, int b) {
        return a >= 0 && b >= 0 && a < grid.cells_u() && b < grid.cells_v() && grid.touches(a, b);
      };
      if (!touched(i, j) && !touched(i - 1, j) && !touched(i, j - 1) && !touched(i - 1, j - 1)) continue;
      const Vec2 q = grid.corner(i, j);
      const SurfaceJet s = evaluate(surface, q.x, q.y, 2);
      if (!is_finite(s.p)) continue;
      box.add(s.p);
      const double bend =
          (hu * hu * length(s.puu) + 2 * hu * hv * length(s.puv) + hv * hv * length(s.pvv)) / 8;
      if (std::isfinite(bend)) rise = std::max(rise, bend);
    }
  const Vec3 pad = Vec3{1, 1, 1} * rise;
  box.lo -= pad, box.hi += pad;
  return box;
}

Box3 intersection(const Box3& a, const Box3& b) {
  Box3 box;
  for (int k = 0; k < 3; ++k) box.lo[k] = std::max(a.lo[k], b.lo[k]), box.hi[k] = std::min(a.hi[k], b.hi[k]);
  return box.empty() ? a : box;
}

}  // namespace

Box3 face_bounds(const Part& part, const Face& face, const std::vector<Box3>& edge_boxes) {
  const Surface& surface = part.surfaces[face.surface];
  const Box3 boundary = boundary_bounds(part, face, edge_boxes);
  if (!face.loops.empty() && is_ruled(surface)) return boundary;
  Box3 inside;
  if (const auto* sphere = std::get_if<Sphere>(&surface.geometry)) {
    add_poles(sphere->frame, surface, face.uv_box, inside);
  } else if (const auto* torus = std::get_if<Torus>(&surface.geometry)) {
    add_poles(torus->frame, surface, face.uv_box, inside);
  } else if (!is_ruled(surface)) {
    inside = intersection(surface_bounds(surface, face.uv_box), sampled_bounds(part, face));
  }
  if (face.loops.empty()) return surface_bounds(surface, face.uv_box);
  inside.add(boundary);
  return inside;
}

}  // namespace dupin::reader
