#include "recognize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bezier.h"
#include "certificate.h"
#include "invert.h"
#include "shape_fit.h"

namespace dupin {
namespace {

constexpr int kSamples = 8;  ///< along each side of the region

/// Points well inside the region, where the surface has a normal.
std::vector<OrientedPoint> sample(const Surface& surface, const Box2& region) {
  std::vector<OrientedPoint> out;
  out.reserve(kSamples * kSamples);
  for (int i = 0; i < kSamples; ++i)
    for (int j = 0; j < kSamples; ++j) {
      const double u = region.lo.x + region.size().x * (i + 0.5) / kSamples;
      const double v = region.lo.y + region.size().y * (j + 0.5) / kSamples;
      const SurfaceJet jet = evaluate(surface, u, v, 1);
      const Vec3 n = cross(jet.pu, jet.pv);
      if (length(n) > 1e-9 * length(jet.pu) * length(jet.pv)) out.push_back({jet.p, normalized(n)});
    }
  return out;
}

bool within(const Surface& shape, const std::vector<OrientedPoint>& points, double tolerance) {
  return std::all_of(points.begin(), points.end(), [&](const OrientedPoint& point) {
    return std::abs(signed_distance(shape, point.p)) <= tolerance;
  });
}

std::optional<Deviation> certify_all(const std::vector<BezierPatch>& patches, double tolerance,
                                     const BoundCell& bound) {
  Deviation out;
  for (const BezierPatch& patch : patches) {
    const auto deviation = certify(patch, {tolerance, kRecognitionAngle}, bound);
    if (!deviation) return std::nullopt;
    out.distance = std::max(out.distance, deviation->distance);
    out.angle = std::max(out.angle, deviation->angle);
  }
  return patches.empty() ? std::nullopt : std::optional(out);
}

/// The length of an isoparametric line through the middle of the region, by chords.
double middle_length(const Surface& surface, const Box2& region, bool along_u) {
  double sum = 0;
  Vec3 before;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = static_cast<double>(i) / kSamples;
    const Vec2 at = region.lo + (along_u ? Vec2{region.size().x * t, region.size().y * 0.5}
                                         : Vec2{region.size().x * 0.5, region.size().y * t});
    const Vec3 p = point_at(surface, at.x, at.y);
    if (i > 0) sum += distance(p, before);
    before = p;
  }
  return sum;
}

/// What the frames are chosen by: a point near the region's middle, its normal, and a tangent along the
/// longer side.
struct Middle {
  Vec3 p, n, along;
};
Middle middle_of(const Surface& surface, const Box2& region) {
  const Vec2 c = region.center();
  const SurfaceJet jet = evaluate(surface, c.x, c.y, 1);
  const bool along_u = middle_length(surface, region, true) >= middle_length(surface, region, false);
  return {jet.p, cross(jet.pu, jet.pv), along_u ? jet.pu : jet.pv};
}

/// The frame about the same axis with the middle at u = π.
Frame3 turned_to(const Frame3& frame, const Middle& middle) {
  const Vec3 d = middle.p - frame.origin, across = d - frame.z * dot(d, frame.z);
  if (!(length(across) > 0)) return frame;
  const Vec3 x = -normalized(across);
  return {frame.origin, x, cross(frame.z, x), frame.z};
}

void orient(Plane& plane, const Middle& middle) {
  Frame3& f = plane.frame;
  if (dot(f.z, middle.n) < 0) f.z = -f.z;
  f.origin = middle.p - f.z * dot(f.z, middle.p - f.origin);
  const Vec3 x = middle.along - f.z * dot(f.z, middle.along);
  f.x = length(x) > 0 ? normalized(x) : any_perpendicular(f.z);
  f.y = cross(f.z, f.x);
}
void orient(Sphere& sphere, const Middle& middle) {
  Frame3& f = sphere.frame;
  const Vec3 radial = normalized(middle.p - f.origin), z = cross(radial, middle.along);
  f.z = length(z) > 0 ? normalized(z) : any_perpendicular(radial);
  f = turned_to(f, middle);
}
void orient(Cone& cone, const Middle& middle) {
  // From the apex to where the region is, so that radii there are of the model's size.
  const double along = dot(cone.frame.z, middle.p - cone.frame.origin);
  cone.radius = std::max(0.0, along * std::tan(cone.half_angle));
  cone.frame.origin += cone.frame.z * std::max(0.0, along);
  cone.frame = turned_to(cone.frame, middle);
}
void orient(Cylinder& cylinder, const Middle& middle) {
  Frame3& f = cylinder.frame;
  f.origin += f.z * dot(f.z, middle.p - f.origin);
  f = turned_to(f, middle);
}
void orient(Torus& torus, const Middle& middle) {
  torus.frame = turned_to(torus.frame, middle);
}
template <class Other>
void orient(Other&, const Middle&) {}

/// A left-handed frame turns Su × Sv around.
template <class Shape>
void match_normal(Shape& shape, const Middle& middle) {
  if constexpr (requires { shape.frame; }) {
    const auto uv = invert({shape}, middle.p, {3.14159265358979323846, 0});
    const SurfaceJet jet = evaluate({shape}, uv->x, uv->y, 1);
    if (dot(cross(jet.pu, jet.pv), middle.n) < 0) shape.frame.y = -shape.frame.y;
  }
}

Surface oriented(Surface shape, const Middle& middle) {
  std::visit(
      [&middle](auto& geometry) {
        orient(geometry, middle);
        match_normal(geometry, middle);
      },
      shape.geometry);
  return shape;
}

std::optional<Recognized> as_shape(const Surface& fitted, const Middle& middle,
                                   const std::vector<BezierPatch>& patches, double tolerance) {
  const Surface shape = oriented(fitted, middle);
  const auto bound = [&](const BezierPatch& cell) -> CellBounds {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (std::abs(signed_distance(shape, point_at(cell, 0.5, 0.5))) > tolerance) return {nan, nan, nan, nan};
    return shape_bounds(shape, cell);
  };
  const auto deviation = certify_all(patches, tolerance, bound);
  if (!deviation) return std::nullopt;
  return Recognized{shape, deviation->distance, deviation->angle};
}

/// u and v exchanged.
BsplineSurface transposed(const BsplineSurface& s) {
  BsplineSurface t = s;
  std::swap(t.degree_u, t.degree_v);
  std::swap(t.knots_u, t.knots_v);
  std::swap(t.count_u, t.count_v);
  std::swap(t.periodic_u, t.periodic_v);
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      const std::size_t from = static_cast<std::size_t>(i) * s.count_v + j,
                        to = static_cast<std::size_t>(j) * s.count_u + i;
      t.poles[to] = s.poles[from];
      if (!s.weights.empty()) t.weights[to] = s.weights[from];
    }
  return t;
}

/// The isoparametric curve at u, turned half around the axis.
Bspline3 opposite_profile(const BsplineSurface& s, double u, const Axis& axis) {
  Bspline3 profile;
  profile.degree = s.degree_v;
  profile.knots = s.knots_v;
  profile.periodic = s.periodic_v;
  for (int j = 0; j < s.count_v; ++j) {  // one column of poles at a time is a curve in u
    Bspline3 along;
    along.degree = s.degree_u;
    along.knots = s.knots_u;
    along.periodic = s.periodic_u;
    Bspline3 weights = along;
    for (int i = 0; i < s.count_u; ++i) {
      const std::size_t index = static_cast<std::size_t>(i) * s.count_v + j;
      along.poles.push_back(s.poles[index]);
      if (!s.weights.empty()) {
        along.weights.push_back(s.weights[index]);
        weights.poles.push_back({s.weights[index], 0, 0});
      }
    }
    const Vec3 d = point_at(Curve3{along}, u) - axis.origin;
    profile.poles.push_back(axis.origin + axis.direction * (2 * dot(axis.direction, d)) - d);
    if (!s.weights.empty()) profile.weights.push_back(point_at(Curve3{weights}, u).x);
  }
  return profile;
}

/// Whether points of one u line have the same distance and height from the axis: u is the angle.
bool turns_with_u(const Surface& surface, const Box2& region, const Axis& axis, double tolerance) {
  for (int j = 0; j < kSamples; ++j) {
    const double v = region.lo.y + region.size().y * (j + 0.5) / kSamples;
    double height = 0, radius = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 d = point_at(surface, region.lo.x + region.size().x * (i + 0.5) / kSamples, v) - axis.origin;
      const double z = dot(d, axis.direction), r = length(cross(axis.direction, d));
      if (i == 0) height = z, radius = r;
      if (!(std::abs(z - height) <= tolerance && std::abs(r - radius) <= tolerance)) return false;
    }
  }
  return true;
}

BezierPatch as_patch(const BezierCurve3& curve) {
  BezierPatch patch;
  patch.degree_v = curve.degree;
  patch.domain = {{0, curve.t0}, {1, curve.t1}};
  patch.rational = true;
  patch.poles = curve.poles;
  return patch;
}

std::optional<Recognized> as_revolution(const BsplineSurface& spline, const Box2& region, const Axis& axis,
                                        const Middle& middle, double tolerance) {
  const Surface surface{spline};
  if (!turns_with_u(surface, region, axis, tolerance)) return std::nullopt;
  Revolution out{axis.origin, axis.direction, {opposite_profile(spline, region.center().x, axis)}};
  const Frame3 frame = [&axis] {
    const Vec3 x = any_perpendicular(axis.direction);
    return Frame3{axis.origin, x, cross(axis.direction, x), axis.direction};
  }();
  const std::vector<BezierCurve3> pieces = bezier_curves(out.profile, region.lo.y, region.hi.y);
  const std::vector<BezierPatch> patches = bezier_patches(surface, region);
  if (pieces.empty() || patches.size() % pieces.size() != 0) return std::nullopt;
  Deviation worst;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const BezierPatch profile = as_patch(pieces[i % pieces.size()]);
    const auto bound = [&](const BezierPatch& cell) {
      const double t0 = surface_to_patch_v(profile, cell.domain.lo.y),
                   t1 = surface_to_patch_v(profile, cell.domain.hi.y);
      return revolution_bounds(frame, subpatch(profile, 0, 1, t0, t1), cell);
    };
    const auto deviation = certify(patches[i], {tolerance, kRecognitionAngle}, bound);
    if (!deviation) return std::nullopt;
    worst = {std::max(worst.distance, deviation->distance), std::max(worst.angle, deviation->angle)};
  }
  // Turning the other way turns Su × Sv around.
  const double pi = 3.14159265358979323846;
  const SurfaceJet jet = evaluate({out}, pi, region.center().y, 1);
  if (dot(cross(jet.pu, jet.pv), middle.n) < 0) out.axis_direction = -out.axis_direction;
  return Recognized{{out}, worst.distance, worst.angle};
}

std::optional<Recognized> as_any_revolution(const BsplineSurface& spline, const Box2& region,
                                            const std::vector<OrientedPoint>& points, const Middle& middle,
                                            double tolerance) {
  Box3 box;
  for (const OrientedPoint& point : points) box.add(point.p);
  std::vector<OrientedPoint> unit = points;
  for (OrientedPoint& point : unit) point.p = (point.p - box.center()) / box.diagonal();
  auto axis = fit_axis(unit);
  if (!axis) return std::nullopt;
  axis->origin = axis->origin * box.diagonal() + box.center();
  if (auto found = as_revolution(spline, region, *axis, middle, tolerance)) return found;
  const Box2 turned{{region.lo.y, region.lo.x}, {region.hi.y, region.hi.x}};
  return as_revolution(transposed(spline), turned, *axis, middle, tolerance);
}

/// Exact: +distance along Su × Sv, which points outward for a right-handed frame.
struct OffsetOf {
  double distance;
  Box2 region;
  std::optional<Surface> operator()(Plane s) const {
    s.frame.origin += cross(s.frame.x, s.frame.y) * distance;
    return Surface{s};
  }
  double outward(const Frame3& f) const { return dot(cross(f.x, f.y), f.z) < 0 ? -distance : distance; }
  std::optional<Surface> operator()(Cylinder s) const {
    s.radius += outward(s.frame);
    return s.radius > 0 ? std::optional(Surface{s}) : std::nullopt;
  }
  std::optional<Surface> operator()(Sphere s) const {
    s.radius += outward(s.frame);
    return s.radius > 0 ? std::optional(Surface{s}) : std::nullopt;
  }
  std::optional<Surface> operator()(Torus s) const {
    s.minor += outward(s.frame);
    return s.minor > 0 && s.major >= s.minor ? std::optional(Surface{s}) : std::nullopt;
  }
  std::optional<Surface> operator()(Cone s) const {
    const double sine = std::sin(s.half_angle), d = outward(s.frame);
    const double least = s.radius + std::min(region.lo.y * sine, region.hi.y * sine);
    s.frame.origin += s.frame.z * (-d * sine);
    s.radius += d * std::cos(s.half_angle);
    const bool one_nappe = least >= 0 && least + d * std::cos(s.half_angle) >= 0 && s.radius >= 0;
    return one_nappe ? std::optional(Surface{s}) : std::nullopt;
  }
  template <class Other>
  std::optional<Surface> operator()(const Other&) const {
    return std::nullopt;
  }
};

std::optional<Recognized> recognize_offset(const OffsetSurface& offset, const Box2& region) {
  const auto surface = std::visit(OffsetOf{offset.distance, region}, offset.base->geometry);
  if (!surface) return std::nullopt;
  const double size = length(point_at(*surface, region.lo.x, region.lo.y)) +
                      length(point_at(*surface, region.hi.x, region.hi.y));
  return Recognized{*surface, 1e-15 * (size + std::abs(offset.distance)), 1e-15};
}

}  // namespace

std::optional<Recognized> recognize(const Surface& surface, const Box2& uv_box, double tolerance) {
  if (surface.geometry.index() <= 4) return std::nullopt;
  if (const auto* offset = std::get_if<OffsetSurface>(&surface.geometry))
    return recognize_offset(*offset, uv_box);
  const std::vector<OrientedPoint> points = sample(surface, uv_box);
  if (points.size() < kSamples * kSamples / 2) return std::nullopt;
  const Middle middle = middle_of(surface, uv_box);
  if (!(length(middle.n) > 0)) return std::nullopt;
  std::vector<BezierPatch> patches;
  for (ShapeKind kind :
       {ShapeKind::plane, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone, ShapeKind::torus}) {
    const auto fitted = fit_shape(kind, points);
    if (!fitted || !within(*fitted, points, tolerance)) continue;
    if (patches.empty()) patches = bezier_patches(surface, uv_box);
    if (auto found = as_shape(*fitted, middle, patches, tolerance)) return found;
  }
  if (const auto* spline = std::get_if<BsplineSurface>(&surface.geometry))
    return as_any_revolution(*spline, uv_box, points, middle, tolerance);
  return std::nullopt;
}

}  // namespace dupin
