// Faces on cylinders, cones and spheres. Whole rectangles of parameters (bores, bosses, fillets, balls) are
// one DP whose footprint and z-range, or two planes, say where it ends; other faces are cut into charts, in
// each of which the surface is a graph over its tangent plane and the trims are boundary pieces. Charts
// overlap freely: every one of them draws the same surface.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "chart_region.h"
#include "quadric_faces.h"

namespace dupin {
namespace {

constexpr double kPi = std::numbers::pi;
/// Angle spanned by one chart of a cylinder or cone; the graph's slope at its border stays below tan 50°.
constexpr double kChartAngle = 100 * kPi / 180;
/// Beyond this half-angle a sector's straight borders are better conditioned as a bound on z than on x.
constexpr double kSideByX = kPi / 4;

Vec3 radial(const Frame3& f, double u) {
  return f.x * std::cos(u) + f.y * std::sin(u);
}

struct Extent {
  double lo, hi;
};

/// Least and largest A cos t + B sin t over [t0, t1].
Extent sinusoid_extent(double a, double b, double t0, double t1) {
  const double f0 = a * std::cos(t0) + b * std::sin(t0), f1 = a * std::cos(t1) + b * std::sin(t1);
  Extent e{std::min(f0, f1), std::max(f0, f1)};
  const double r = std::hypot(a, b), peak = std::atan2(b, a);
  auto holds = [&](double t) {
    const double k = std::ceil((t0 - t) / (2 * kPi));
    return t + k * 2 * kPi <= t1;
  };
  if (holds(peak)) e.hi = r;
  if (holds(peak + kPi)) e.lo = -r;
  return e;
}

/// Least and largest d·(S(u,v) − origin) over a rectangle of parameters.
Extent extent_along(const Surface& surface, const Box2& uv, const Vec3& origin, const Vec3& d) {
  if (const auto* s = std::get_if<Sphere>(&surface.geometry)) {
    const Extent around = sinusoid_extent(dot(d, s->frame.x), dot(d, s->frame.y), uv.lo.x, uv.hi.x);
    const double up = dot(d, s->frame.z), base = dot(d, s->frame.origin - origin);
    return {base + s->radius * sinusoid_extent(around.lo, up, uv.lo.y, uv.hi.y).lo,
            base + s->radius * sinusoid_extent(around.hi, up, uv.lo.y, uv.hi.y).hi};
  }
  const auto* cylinder = std::get_if<Cylinder>(&surface.geometry);
  const auto* cone = std::get_if<Cone>(&surface.geometry);
  const Frame3& f = cylinder ? cylinder->frame : cone->frame;
  Extent e{1e300, -1e300};
  for (double v : {uv.lo.y, uv.hi.y}) {
    const double r = cylinder ? cylinder->radius : cone->radius + v * std::sin(cone->half_angle);
    const double h = cylinder ? v : v * std::cos(cone->half_angle);
    const Extent around = sinusoid_extent(r * dot(d, f.x), r * dot(d, f.y), uv.lo.x, uv.hi.x);
    const double base = dot(d, f.origin - origin + f.z * h);
    e = {std::min(e.lo, base + around.lo), std::max(e.hi, base + around.hi)};
  }
  return e;
}

const Frame3& frame_of(const Surface& s) {
  if (const auto* c = std::get_if<Cylinder>(&s.geometry)) return c->frame;
  if (const auto* c = std::get_if<Cone>(&s.geometry)) return c->frame;
  return std::get<Sphere>(s.geometry).frame;
}

/// Su × Sv, not normalised, at a regular point.
Vec3 surface_normal(const Surface& s, Vec2 uv) {
  const SurfaceJet jet = evaluate(s, uv.x, uv.y, 1);
  return cross(jet.pu, jet.pv);
}

/// The inward side of the surface (towards axis or centre) at a regular point.
Vec3 inward(const Surface& s, Vec2 uv) {
  const Frame3& f = frame_of(s);
  Vec3 n = normalized(surface_normal(s, uv));
  const Vec3 p = point_at(s, uv.x, uv.y);
  Vec3 to_axis = f.origin - p;
  if (!std::holds_alternative<Sphere>(s.geometry)) to_axis = to_axis - f.z * dot(to_axis, f.z);
  return dot(n, to_axis) >= 0 ? n : -n;
}

class CurvedQuadric {
 public:
  CurvedQuadric(const QuadricFaceInput& in, PartDps& out)
      : in_(in), out_(out), implicit_(implicit_quadric(in.surface)) {}

  int make() {
    if (in_.rectangle.rectangle) {
      if (std::holds_alternative<Cylinder>(in_.surface.geometry)) {
        if (make_cylinder_rectangle()) return 1;
      } else if (around() >= 2 * kPi - 1e-9) {
        if (std::holds_alternative<Sphere>(in_.surface.geometry)) return make_sphere_zone();
        if (make_whole_cone()) return 1;
      }
    }
    return std::holds_alternative<Sphere>(in_.surface.geometry) ? make_sphere_charts() : make_sectors();
  }

 private:
  double around() const { return in_.uv_box.size().x; }

  QuadricDp dp_at(Vec2 uv) const {
    QuadricDp dp = quadric_dp_at(implicit_, point_at(in_.surface, uv.x, uv.y), inward(in_.surface, uv));
    dp.exact = true;
    dp.bound = in_.rectangle.bound;
    dp.face = in_.face_index;
    dp.cell = in_.uv_box;
    const Vec3 outward = surface_normal(in_.surface, uv) * (in_.outward_is_normal ? 1.0 : -1.0);
    dp.flipped = dot(dp.n(), outward) < 0;
    return dp;
  }

  static void set_footprint(QuadricDp& dp, Extent x, Extent y) {
    dp.footprint = {Vec2{x.lo, y.lo}, Vec2{x.hi, y.lo}, Vec2{x.hi, y.hi}, Vec2{x.lo, y.hi}};
  }

  static std::uint8_t bit(bool on, int i) { return static_cast<std::uint8_t>(on ? 1u << i : 0u); }

  /// Ends across the axis are the footprint's sides along û; a sector's straight borders are its other sides,
  /// or a bound on z.
  bool make_cylinder_rectangle() {
    const Cylinder& cylinder = std::get<Cylinder>(in_.surface.geometry);
    const Box2 box = in_.uv_box;
    const double half = std::min(around() / 2, kPi), r = cylinder.radius;
    const bool whole = half >= kPi - 1e-9;
    const bool* drawn = in_.rectangle.side_drawn;
    const bool by_x = !whole && half <= kSideByX;
    if (!by_x && !whole && drawn[0] != drawn[1])
      return false;  // one bit for both borders: the charts keep them apart
    QuadricDp dp = dp_at(box.center());
    const bool v_with_axis = dot(dp.v, cylinder.frame.z) > 0;
    // û may run with or against u; the sides are told apart by a point.
    const bool u_with_angle = dot(dp.u, radial(cylinder.frame, box.center().x + kPi / 2)) > 0;
    const double h = box.size().y / 2, wide = by_x ? r * std::sin(half) : r * (1 + 1e-3);
    set_footprint(dp, {-wide, wide}, {-h, h});
    dp.z_lo = -1e-4 * r;
    dp.z_hi = whole  ? r * (2 + 1e-4)
              : by_x ? r * (1 - std::cos(half)) * 1.001 + 1e-6 * r
                     : r * (1 - std::cos(half));
    const int low = v_with_axis ? 2 : 3, first = u_with_angle ? 0 : 1;
    dp.feature_sides = bit(drawn[low], 0) | bit(drawn[5 - low], 2);
    if (by_x)
      dp.feature_sides |= bit(drawn[1 - first], 1) | bit(drawn[first], 3);
    else if (!whole)
      dp.feature_sides |= bit(drawn[0], 5);
    emit_dp(dp, {}, {}, true, out_);
    return true;
  }

  /// A ball, a cap or a zone between two parallels: seen from the pole, a range of z.
  int make_sphere_zone() {
    const Sphere& sphere = std::get<Sphere>(in_.surface.geometry);
    const double r = sphere.radius, v0 = in_.uv_box.lo.y, v1 = in_.uv_box.hi.y;
    QuadricDp dp = quadric_dp_at(implicit_, sphere.frame.origin + sphere.frame.z * r, -sphere.frame.z);
    dp.exact = true, dp.bound = in_.rectangle.bound, dp.face = in_.face_index, dp.cell = in_.uv_box;
    const Vec2 mid = in_.uv_box.center();
    const bool normal_outward = dot(surface_normal(in_.surface, mid), radial(sphere.frame, mid.x)) > 0;
    dp.flipped = normal_outward == in_.outward_is_normal;
    const double wide = r * (1 + 1e-3);
    set_footprint(dp, {-wide, wide}, {-wide, wide});
    const bool north = v1 >= kPi / 2 - 1e-9, south = v0 <= -kPi / 2 + 1e-9;
    dp.z_lo = north ? -1e-4 * r : r * (1 - std::sin(v1));
    dp.z_hi = south ? r * (2 + 1e-4) : r * (1 - std::sin(v0));
    dp.feature_sides =
        bit(in_.rectangle.side_drawn[3] && !north, 4) | bit(in_.rectangle.side_drawn[2] && !south, 5);
    emit_dp(dp, {}, {}, true, out_);
    return 1;
  }

  /// A cone all round between two planes across its axis.
  bool make_whole_cone() {
    const Cone& cone = std::get<Cone>(in_.surface.geometry);
    const double sine = std::sin(cone.half_angle), cosine = std::cos(cone.half_angle),
                 apex = -cone.radius / sine;
    const double v0 = in_.uv_box.lo.y, v1 = in_.uv_box.hi.y;
    if (v0 < apex - 1e-9 * (v1 - v0) && v1 > apex + 1e-9 * (v1 - v0)) return false;  // both nappes
    // The middle, moved off the apex: any point of the nappe describes the same cone.
    QuadricDp dp = dp_at({in_.uv_box.center().x, (v0 + v1) / 2});
    Extent e[3];
    const Vec3 axes[3] = {dp.u, dp.v, dp.n()};
    for (int i = 0; i < 3; ++i) e[i] = extent_along(in_.surface, in_.uv_box, dp.origin, axes[i]);
    const double margin = 1e-3 * (e[0].hi - e[0].lo);
    set_footprint(dp, {e[0].lo - margin, e[0].hi + margin}, {e[1].lo - margin, e[1].hi + margin});
    dp.z_lo = e[2].lo - margin, dp.z_hi = e[2].hi + margin;
    dp.first_plane = static_cast<std::uint32_t>(out_.planes.size());
    const Vec3 axis{dot(cone.frame.z, dp.u), dot(cone.frame.z, dp.v), dot(cone.frame.z, dp.n())};
    const double at = dot(cone.frame.z, dp.origin - cone.frame.origin);  // height of the DP's origin
    const double size = std::abs(v1 - v0) * cosine;
    auto add_end = [&](double v, bool upper, bool drawn) {
      // At the apex itself the plane is left a hair inside it: the other nappe must not show.
      const bool tip = std::abs(v - apex) * cosine < 1e-9 * size;
      const double height = v * cosine + (tip ? (upper ? -1e-7 : 1e-7) * size : 0);
      out_.planes.push_back(upper ? ClipPlane{-axis, height - at, drawn && !tip}
                                  : ClipPlane{axis, at - height, drawn && !tip});
    };
    add_end(v0, false, in_.rectangle.side_drawn[2]);
    add_end(v1, true, in_.rectangle.side_drawn[3]);
    dp.planes = 2;
    emit_dp(dp, {}, {}, true, out_);
    return true;
  }

  /// One chart around uv0 with the rectangle of parameters it has to cover, and the trims on its sheet.
  int make_chart(QuadricDp dp, const Box2& uv) {
    const Vec3 axes[3] = {dp.u, dp.v, dp.n()};
    Extent e[3];
    for (int i = 0; i < 3; ++i) e[i] = extent_along(in_.surface, uv, dp.origin, axes[i]);
    const double margin = 1e-5 * std::max(e[0].hi - e[0].lo, e[1].hi - e[1].lo) + 2 * in_.boundary.reach;
    set_footprint(dp, {e[0].lo - margin, e[0].hi + margin}, {e[1].lo - margin, e[1].hi + margin});
    dp.z_lo = e[2].lo - margin, dp.z_hi = e[2].hi + margin;
    dp.cell = uv;
    ChartProjector chart(dp);
    ChartPieces pieces;
    for (const FaceLoop& loop : in_.boundary.loops)
      for (const FaceArc& arc : loop.arcs)
        if (chart.add(arc, pieces)) dp.bound = std::max(dp.bound, arc.bound);
    const auto [reference, state] = reference_in(uv, chart, pieces);
    if (pieces.count() <= kMaxPieces) narrow_to_sector(dp, uv);
    return emit_exact_dp(dp, pieces, reference, state, out_);
  }

  /// A cone's sector in its chart lies between two straight generators: the rectangle around it reaches, at
  /// its narrow end, over the edge of the sheet.
  void narrow_to_sector(QuadricDp& dp, const Box2& uv) const {
    if (!std::holds_alternative<Cone>(in_.surface.geometry)) return;
    const double y0 = dp.footprint[0].y, y1 = dp.footprint[2].y;
    double x[2][2];  // [generator][lower, upper end]
    for (int g = 0; g < 2; ++g) {
      Vec2 a[2];
      for (int k = 0; k < 2; ++k) {
        const Vec3 d = point_at(in_.surface, g ? uv.hi.x : uv.lo.x, k ? uv.hi.y : uv.lo.y) - dp.origin;
        a[k] = {dot(d, dp.u), dot(d, dp.v)};
      }
      const Vec2 along = a[1] - a[0];
      if (!(std::abs(along.y) > 1e-6 * length(along))) return;
      x[g][0] = a[0].x + along.x * (y0 - a[0].y) / along.y,
      x[g][1] = a[0].x + along.x * (y1 - a[0].y) / along.y;
    }
    const double margin = 1e-3 * (dp.footprint[1].x - dp.footprint[0].x);
    double lo[2], hi[2];
    for (int k = 0; k < 2; ++k)
      lo[k] = std::min(x[0][k], x[1][k]) - margin, hi[k] = std::max(x[0][k], x[1][k]) + margin;
    const bool crossed = (x[0][0] < x[1][0]) != (x[0][1] < x[1][1]);
    if (crossed) return;  // the apex is within: the rectangle ends there
    dp.footprint = {Vec2{lo[0], y0}, Vec2{hi[0], y0}, Vec2{hi[1], y1}, Vec2{lo[1], y1}};
  }

  /// A point of the chart, as far from the trims as a few tries give, and whether it is inside the face.
  std::pair<Vec2, bool> reference_in(const Box2& uv, const ChartProjector& chart,
                                     const ChartPieces& pieces) const {
    Vec3 best{};
    double most = -1;
    const int tries = pieces.empty() ? 1 : 5;
    for (int i = 0; i < tries; ++i)
      for (int j = 0; j < tries; ++j) {
        const double fu = tries == 1 ? 0.5 : 0.13 + 0.185 * i, fv = tries == 1 ? 0.5 : 0.11 + 0.193 * j;
        const Vec3 p = point_at(in_.surface, uv.lo.x + uv.size().x * fu, uv.lo.y + uv.size().y * fv);
        const double c = clearance(pieces, chart.to_chart(p));
        if (c > most) most = c, best = p;
      }
    return {chart.to_chart(best), in_.inside(best)};
  }

  int make_sectors() {
    const Box2 box = in_.uv_box;
    const int count = std::max(1, static_cast<int>(std::ceil(around() / kChartAngle - 1e-9)));
    int made = 0;
    for (int i = 0; i < count; ++i) {
      Box2 uv = box;
      uv.lo.x = box.lo.x + around() * i / count, uv.hi.x = box.lo.x + around() * (i + 1) / count;
      made += make_chart(dp_at(off_apex(uv.center(), box)), uv);
    }
    return made;
  }

  /// A cone's chart must not be centred on its apex.
  Vec2 off_apex(Vec2 uv, const Box2& box) const {
    if (const auto* cone = std::get_if<Cone>(&in_.surface.geometry)) {
      const double apex = -cone->radius / std::sin(cone->half_angle);
      if (std::abs(uv.y - apex) < 0.05 * box.size().y) uv.y += 0.25 * box.size().y;
    }
    return uv;
  }

  int make_sphere_charts() {
    const Sphere& sphere = std::get<Sphere>(in_.surface.geometry);
    const double r = sphere.radius;
    const Vec2 mid = in_.uv_box.center();
    const Vec3 out = normalized(point_at(in_.surface, mid.x, mid.y) - sphere.frame.origin);
    if (extent_along(in_.surface, in_.uv_box, sphere.frame.origin, out).lo >= 0.3 * r)
      return make_chart(dp_at(mid), in_.uv_box);
    int made = 0;
    for (int side = 0; side < 6; ++side) {
      const Vec3 axis = (side / 2 == 0   ? sphere.frame.x
                         : side / 2 == 1 ? sphere.frame.y
                                         : sphere.frame.z) *
                        (side % 2 ? -1.0 : 1.0);
      made += make_cube_chart(sphere, axis);
    }
    return made;
  }

  /// The part of the sphere that a side of the cube around it projects to.
  int make_cube_chart(const Sphere& sphere, const Vec3& axis) {
    const double r = sphere.radius, wide = r * (std::sqrt(0.5) + 1e-6);
    QuadricDp dp = quadric_dp_at(implicit_, sphere.frame.origin + axis * r, -axis);
    dp.exact = true, dp.bound = in_.rectangle.bound, dp.face = in_.face_index, dp.cell = in_.uv_box;
    const Vec2 mid = in_.uv_box.center();
    const bool normal_outward =
        dot(surface_normal(in_.surface, mid), point_at(in_.surface, mid.x, mid.y) - sphere.frame.origin) > 0;
    dp.flipped = normal_outward == in_.outward_is_normal;
    set_footprint(dp, {-wide, wide}, {-wide, wide});
    dp.z_lo = -1e-4 * r,
    dp.z_hi = r * 0.6;  // the cube's corners reach 0.423 r; the footprint's rim lies beyond
    ChartProjector chart(dp);
    ChartPieces pieces;
    for (const FaceLoop& loop : in_.boundary.loops)
      for (const FaceArc& arc : loop.arcs)
        if (chart.add(arc, pieces)) dp.bound = std::max(dp.bound, arc.bound);
    Vec2 best{};
    double most = -1;
    for (double fy : {0.03, 0.41, -0.37, 0.2, -0.22})
      for (double fx : {-0.02, 0.43, -0.39, 0.23, -0.19}) {
        const double c = clearance(pieces, Vec2{fx * r, fy * r});
        if (c > most) most = c, best = {fx * r, fy * r};
      }
    const double height = std::sqrt(r * r - dot(best, best));
    const Vec3 p = sphere.frame.origin + dp.u * best.x + dp.v * best.y + axis * height;
    return emit_exact_dp(dp, pieces, best, in_.inside(p), out_);
  }

  const QuadricFaceInput& in_;
  PartDps& out_;
  const ImplicitQuadric implicit_;
};

}  // namespace

ImplicitQuadric implicit_quadric(const Surface& surface) {
  ImplicitQuadric q;
  const auto centred = [&](const Vec3& origin) {
    // Centred coordinates: linear = −2Ao, constant = oᵀAo (+ what the kind adds).
    const Vec3 a{q.axx_ayy_azz.x * origin.x + q.ayz_axz_axy.z * origin.y + q.ayz_axz_axy.y * origin.z,
                 q.ayz_axz_axy.z * origin.x + q.axx_ayy_azz.y * origin.y + q.ayz_axz_axy.x * origin.z,
                 q.ayz_axz_axy.y * origin.x + q.ayz_axz_axy.x * origin.y + q.axx_ayy_azz.z * origin.z};
    q.linear = -a;
    q.constant = dot(origin, a);
  };
  const auto axis_form = [&](const Vec3& a, double diagonal, double outer) {
    q.axx_ayy_azz = {diagonal + outer * a.x * a.x, diagonal + outer * a.y * a.y,
                     diagonal + outer * a.z * a.z};
    q.ayz_axz_axy = {outer * a.y * a.z, outer * a.x * a.z, outer * a.x * a.y};
  };
  if (const auto* c = std::get_if<Cylinder>(&surface.geometry)) {
    axis_form(c->frame.z, 1, -1);
    centred(c->frame.origin);
    q.constant -= c->radius * c->radius;
  } else if (const auto* c = std::get_if<Cone>(&surface.geometry)) {
    const double cosine = std::cos(c->half_angle);
    axis_form(c->frame.z, -cosine * cosine, 1);
    centred(c->frame.origin - c->frame.z * (c->radius / std::tan(c->half_angle)));
  } else if (const auto* s = std::get_if<Sphere>(&surface.geometry)) {
    axis_form({1, 0, 0}, 1, 0);
    centred(s->frame.origin);
    q.constant -= s->radius * s->radius;
  }
  return q;
}

Vec3 gradient(const ImplicitQuadric& q, const Vec3& p) {
  const Vec3 a{q.axx_ayy_azz.x * p.x + q.ayz_axz_axy.z * p.y + q.ayz_axz_axy.y * p.z,
               q.ayz_axz_axy.z * p.x + q.axx_ayy_azz.y * p.y + q.ayz_axz_axy.x * p.z,
               q.ayz_axz_axy.y * p.x + q.ayz_axz_axy.x * p.y + q.axx_ayy_azz.z * p.z};
  return (a + q.linear) * 2;
}

double value(const ImplicitQuadric& q, const Vec3& p) {
  const Vec3 g = gradient(q, p);
  return dot(g * 0.5 + q.linear, p) + q.constant;
}

QuadricDp quadric_dp_at(const ImplicitQuadric& q, const Vec3& p, const Vec3& n) {
  const auto form = [&](const Vec3& a, const Vec3& b) {
    const Vec3 ab{q.axx_ayy_azz.x * b.x + q.ayz_axz_axy.z * b.y + q.ayz_axz_axy.y * b.z,
                  q.ayz_axz_axy.z * b.x + q.axx_ayy_azz.y * b.y + q.ayz_axz_axy.x * b.z,
                  q.ayz_axz_axy.y * b.x + q.ayz_axz_axy.x * b.y + q.axx_ayy_azz.z * b.z};
    return dot(a, ab);
  };
  const Vec3 e1 = any_perpendicular(n), e2 = cross(n, e1);
  const double g = dot(gradient(q, p), n);  // Q = g·z + …
  const double m11 = -2 * form(e1, e1) / g, m12 = -2 * form(e1, e2) / g, m22 = -2 * form(e2, e2) / g;
  // Jacobi rotation of the symmetric 2×2 matrix.
  const double angle = 0.5 * std::atan2(2 * m12, m11 - m22);
  double c = std::cos(angle), s = std::sin(angle);
  double k1 = m11 * c * c + 2 * m12 * c * s + m22 * s * s, k2 = m11 * s * s - 2 * m12 * c * s + m22 * c * c;
  QuadricDp dp;
  dp.origin = p;
  dp.u = normalized(e1 * c + e2 * s);
  dp.v = cross(n, dp.u);
  if (std::abs(k2) > std::abs(k1)) {
    std::swap(k1, k2);
    dp.u = dp.v;
    dp.v = cross(n, dp.u);
  }
  const double scale = std::max(std::abs(k1), std::abs(k2));
  dp.lambda_u = k1;
  dp.lambda_v = std::abs(k2) <= 1e-15 * scale ? 0 : k2;
  const auto clean = [&](double x) { return std::abs(x) <= 1e-15 * scale ? 0 : x; };
  dp.a = clean(-2 * form(dp.u, n) / g), dp.b = clean(-2 * form(dp.v, n) / g),
  dp.c = clean(-2 * form(n, n) / g);
  return dp;
}

int make_curved_quadric_face(const QuadricFaceInput& in, PartDps& out) {
  return CurvedQuadric(in, out).make();
}

}  // namespace dupin
