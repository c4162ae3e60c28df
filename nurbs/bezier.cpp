// Bézier patches and curves of every rational kind.
//
// Every kind but the plane and the B-spline is a sweep: a profile in homogeneous Bézier pieces, turned along
// arcs or moved along a line. An arc from u0 to u1 of half angle h about its middle m is the rational
// quadratic with homogeneous coefficients (cos u0, sin u0, 1), (cos m, sin m, cos h), (cos u1, sin u1, 1).
#include "bezier.h"

#include <array>
#include <numbers>

#include "extraction.h"
#include "homogeneous.h"
#include "knots.h"

namespace dupin {

using namespace homogeneous;

namespace {

/// c, s, w: numerators of cos and sin, and their denominator.
struct Arc {
  double u0, u1;
  std::array<double, 3> c, s, w;
};

/// [u0, u1] in equal arcs of at most a quarter turn.
std::vector<Arc> arcs(double u0, double u1) {
  std::vector<Arc> out;
  if (!(u1 > u0)) return out;
  const int count = std::max(1, static_cast<int>(std::ceil((u1 - u0) / (std::numbers::pi / 2) - 1e-9)));
  out.reserve(count);
  for (int i = 0; i < count; ++i) {
    const double a = u0 + (u1 - u0) * i / count, b = i + 1 < count ? u0 + (u1 - u0) * (i + 1) / count : u1;
    const double m = 0.5 * (a + b);
    out.push_back({a,
                   b,
                   {std::cos(a), std::cos(m), std::cos(b)},
                   {std::sin(a), std::sin(m), std::sin(b)},
                   {1, std::cos(0.5 * (b - a)), 1}});
  }
  return out;
}

BezierPatch empty_patch(int degree_u, int degree_v, const Box2& domain, bool rational) {
  BezierPatch patch;
  patch.degree_u = degree_u;
  patch.degree_v = degree_v;
  patch.domain = domain;
  patch.rational = rational;
  patch.poles.resize(static_cast<std::size_t>(degree_u + 1) * (degree_v + 1));
  return patch;
}

/// How one kind of curve turns into pieces; nothing for offset curves and hyperbolas.
struct CurvePieces {
  const double t0, t1;

  std::vector<BezierCurve3> operator()(const LineOf<Vec3>& line) const {
    const Vec3 a = line.origin + line.direction * t0, b = line.origin + line.direction * t1;
    return {{1, t0, t1, false, {lifted(a, 1), lifted(b, 1)}}};
  }
  std::vector<BezierCurve3> conic(const Vec3& center, const Vec3& a, const Vec3& b) const {
    std::vector<BezierCurve3> out;
    for (const Arc& arc : arcs(t0, t1)) {
      BezierCurve3 piece{2, arc.u0, arc.u1, true, std::vector<Vec4>(3)};
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = center * arc.w[k] + (a * arc.c[k] + b * arc.s[k]);
        piece.poles[k] = {p.x, p.y, p.z, arc.w[k]};
      }
      out.push_back(std::move(piece));
    }
    return out;
  }
  std::vector<BezierCurve3> operator()(const CircleOf<Vec3>& c) const {
    return conic(c.center, c.x * c.radius, c.y * c.radius);
  }
  std::vector<BezierCurve3> operator()(const EllipseOf<Vec3>& e) const {
    return conic(e.center, e.x * e.major, e.y * e.minor);
  }
  std::vector<BezierCurve3> operator()(const ParabolaOf<Vec3>& p) const {
    const auto polar = [&p](double a, double b) {
      return lifted(p.vertex + (p.x * (a * b / (4 * p.focal)) + p.y * (0.5 * (a + b))), 1);
    };
    return {{2, t0, t1, false, {polar(t0, t0), polar(t0, t1), polar(t1, t1)}}};
  }
  std::vector<BezierCurve3> operator()(const Bspline3& s) const {
    std::vector<BezierCurve3> out;
    std::array<double, (kMaxDegree + 1) * (kMaxDegree + 1)> matrix;
    const int p = s.degree;
    for (const SplinePiece& piece : spline_pieces(s.knots, p, s.periodic, t0, t1)) {
      extraction_matrix(s.knots, p, piece, matrix.data());
      BezierCurve3 curve{p, piece.t0, piece.t1, false, std::vector<Vec4>(p + 1)};
      for (int k = 0; k <= p; ++k) {
        Vec4 pole;
        for (int j = 0; j <= p; ++j) {
          const int index = piece.span - p + j;
          const double weight = s.weights.empty() ? 1 : s.weights[index];
          pole = sum(pole, scaled(lifted(s.poles[index], weight), matrix[k * (p + 1) + j]));
        }
        if (s.weights.empty()) pole.w = 1;
        curve.poles[k] = pole;
      }
      out.push_back(std::move(curve));
    }
    return out;
  }
  std::vector<BezierCurve3> operator()(const HyperbolaOf<Vec3>&) const { return {}; }
  std::vector<BezierCurve3> operator()(const OffsetCurveOf<Vec3>&) const { return {}; }
};

bool has_weights(const BezierCurve3& curve) {
  for (const Vec4& pole : curve.poles)
    if (pole.w != 1) return true;
  return false;
}

/// A profile piece (ρ, z, w) in the half plane of a frame: what cylinder, cone, sphere and torus turn about.
struct Meridian {
  double v0, v1;
  int degree;
  bool is_angle;
  std::array<double, 3> rho, z, w;
};

/// The meridian pieces turned about the frame's Z over the region's angles.
std::vector<BezierPatch> turn(const Frame3& f, const std::vector<Meridian>& profile, const Box2& region) {
  std::vector<BezierPatch> out;
  const std::vector<Arc> turns = arcs(region.lo.x, region.hi.x);
  out.reserve(turns.size() * profile.size());
  for (const Arc& arc : turns)
    for (const Meridian& m : profile) {
      BezierPatch patch = empty_patch(2, m.degree, {{arc.u0, m.v0}, {arc.u1, m.v1}}, true);
      patch.u_is_angle = true;
      patch.v_is_angle = m.is_angle;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= m.degree; ++j) {
          const double w = arc.w[i] * m.w[j];
          const Vec3 p =
              f.origin * w + ((f.x * arc.c[i] + f.y * arc.s[i]) * m.rho[j] + f.z * (m.z[j] * arc.w[i]));
          patch.pole(i, j) = {p.x, p.y, p.z, w};
        }
      out.push_back(std::move(patch));
    }
  return out;
}

/// The straight meridian with radius r(v) = radius + v·slope and height v·rise.
std::vector<BezierPatch> turn_line(const Frame3& f, double radius, double slope, double rise,
                                   const Box2& region) {
  const double v0 = region.lo.y, v1 = region.hi.y;
  return turn(
      f, {{v0, v1, 1, false, {radius + v0 * slope, radius + v1 * slope}, {v0 * rise, v1 * rise}, {1, 1}}},
      region);
}

std::vector<BezierPatch> turn_circle(const Frame3& f, double major, double minor, const Box2& region) {
  std::vector<Meridian> profile;
  for (const Arc& arc : arcs(region.lo.y, region.hi.y)) {
    Meridian m{arc.u0, arc.u1, 2, true, {}, {}, arc.w};
    for (int j = 0; j < 3; ++j) m.rho[j] = major * arc.w[j] + minor * arc.c[j], m.z[j] = minor * arc.s[j];
    profile.push_back(m);
  }
  return turn(f, profile, region);
}

std::vector<BezierPatch> patches(const Plane& plane, const Box2& region) {
  BezierPatch patch = empty_patch(1, 1, region, false);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double u = i ? region.hi.x : region.lo.x, v = j ? region.hi.y : region.lo.y;
      patch.pole(i, j) = lifted(plane.frame.origin + plane.frame.x * u + plane.frame.y * v, 1);
    }
  return {patch};
}
std::vector<BezierPatch> patches(const Cylinder& c, const Box2& region) {
  return turn_line(c.frame, c.radius, 0, 1, region);
}
std::vector<BezierPatch> patches(const Cone& c, const Box2& region) {
  return turn_line(c.frame, c.radius, std::sin(c.half_angle), std::cos(c.half_angle), region);
}
std::vector<BezierPatch> patches(const Sphere& s, const Box2& region) {
  return turn_circle(s.frame, 0, s.radius, region);
}
std::vector<BezierPatch> patches(const Torus& t, const Box2& region) {
  return turn_circle(t.frame, t.major, t.minor, region);
}
std::vector<BezierPatch> patches(const OffsetSurface&, const Box2&) {
  return {};
}

std::vector<BezierPatch> patches(const Revolution& s, const Box2& region) {
  std::vector<BezierPatch> out;
  const std::vector<Arc> turns = arcs(region.lo.x, region.hi.x);
  const std::vector<BezierCurve3> profile = bezier_curves(s.profile, region.lo.y, region.hi.y);
  out.reserve(turns.size() * profile.size());
  for (const Arc& arc : turns)
    for (const BezierCurve3& piece : profile) {
      BezierPatch patch = empty_patch(2, piece.degree, {{arc.u0, piece.t0}, {arc.u1, piece.t1}}, true);
      patch.u_is_angle = true;
      patch.v_is_angle = piece.is_angle;
      for (int j = 0; j <= piece.degree; ++j) {
        const double w = piece.poles[j].w;
        const Vec3 q = xyz(piece.poles[j]) - s.axis_origin * w;
        const Vec3 along = s.axis_direction * dot(s.axis_direction, q), across = q - along;
        const Vec3 turned = cross(s.axis_direction, across), foot = s.axis_origin * w + along;
        for (int i = 0; i < 3; ++i) {
          const Vec3 p = foot * arc.w[i] + (across * arc.c[i] + turned * arc.s[i]);
          patch.pole(i, j) = {p.x, p.y, p.z, w * arc.w[i]};
        }
      }
      out.push_back(std::move(patch));
    }
  return out;
}

std::vector<BezierPatch> patches(const Extrusion& s, const Box2& region) {
  std::vector<BezierPatch> out;
  for (const BezierCurve3& piece : bezier_curves(s.profile, region.lo.x, region.hi.x)) {
    const Box2 domain{{piece.t0, region.lo.y}, {piece.t1, region.hi.y}};
    BezierPatch patch = empty_patch(piece.degree, 1, domain, has_weights(piece));
    patch.u_is_angle = piece.is_angle;
    for (int i = 0; i <= piece.degree; ++i)
      for (int j = 0; j < 2; ++j) {
        const Vec4& q = piece.poles[i];
        const Vec3 p = xyz(q) + s.direction * (q.w * (j ? region.hi.y : region.lo.y));
        patch.pole(i, j) = {p.x, p.y, p.z, q.w};
      }
    out.push_back(std::move(patch));
  }
  return out;
}

bool is_rational(const BsplineSurface& s) {
  for (double w : s.weights)
    if (w != s.weights.front()) return true;
  return false;
}

/// Rows of Bézier poles along u, for all columns that the region needs: strip[k * columns + (j - first)].
void extract_strip(const BsplineSurface& s, bool rational, const SplinePiece& piece, int first, int columns,
                   const double* matrix, std::vector<Vec4>& strip) {
  const int p = s.degree_u;
  strip.assign(static_cast<std::size_t>(p + 1) * columns, Vec4{});
  for (int i = 0; i <= p; ++i) {
    const std::size_t row = static_cast<std::size_t>(piece.span - p + i) * s.count_v + first;
    for (int j = 0; j < columns; ++j) {
      const Vec4 pole = lifted(s.poles[row + j], rational ? s.weights[row + j] : 1);
      for (int k = 0; k <= p; ++k) {
        Vec4& to = strip[static_cast<std::size_t>(k) * columns + j];
        to = sum(to, scaled(pole, matrix[k * (p + 1) + i]));
      }
    }
  }
}

std::vector<BezierPatch> patches(const BsplineSurface& s, const Box2& region) {
  const int p = s.degree_u, q = s.degree_v;
  const bool rational = is_rational(s);
  const auto pieces_u = spline_pieces(s.knots_u, p, s.periodic_u, region.lo.x, region.hi.x);
  const auto pieces_v = spline_pieces(s.knots_v, q, s.periodic_v, region.lo.y, region.hi.y);
  std::vector<BezierPatch> out;
  if (pieces_u.empty() || pieces_v.empty()) return out;
  out.reserve(pieces_u.size() * pieces_v.size());
  const std::size_t square = static_cast<std::size_t>(q + 1) * (q + 1);
  std::vector<double> matrices_v(square * pieces_v.size());
  int first = s.count_v, last = 0;
  for (std::size_t b = 0; b < pieces_v.size(); ++b) {
    extraction_matrix(s.knots_v, q, pieces_v[b], &matrices_v[b * square]);
    first = std::min(first, pieces_v[b].span - q);
    last = std::max(last, pieces_v[b].span);
  }
  const int columns = last - first + 1;
  std::vector<Vec4> strip;
  std::array<double, (kMaxDegree + 1) * (kMaxDegree + 1)> matrix_u;
  for (const SplinePiece& a : pieces_u) {
    extraction_matrix(s.knots_u, p, a, matrix_u.data());
    extract_strip(s, rational, a, first, columns, matrix_u.data(), strip);
    for (std::size_t b = 0; b < pieces_v.size(); ++b) {
      BezierPatch patch = empty_patch(p, q, {{a.t0, pieces_v[b].t0}, {a.t1, pieces_v[b].t1}}, rational);
      const double* matrix_v = &matrices_v[b * square];
      for (int k = 0; k <= p; ++k) {
        const Vec4* row = &strip[static_cast<std::size_t>(k) * columns + (pieces_v[b].span - q - first)];
        for (int l = 0; l <= q; ++l) {
          Vec4 pole;
          for (int j = 0; j <= q; ++j) pole = sum(pole, scaled(row[j], matrix_v[l * (q + 1) + j]));
          if (!rational) pole.w = 1;
          patch.pole(k, l) = pole;
        }
      }
      out.push_back(std::move(patch));
    }
  }
  return out;
}

double arc_angle(double lo, double hi, double s) {
  return 0.5 * (lo + hi) + 2 * std::atan((2 * s - 1) * std::tan(0.25 * (hi - lo)));
}
double arc_parameter(double lo, double hi, double u) {
  return 0.5 + std::tan(0.5 * (u - 0.5 * (lo + hi))) / (2 * std::tan(0.25 * (hi - lo)));
}
double to_surface(bool is_angle, double lo, double hi, double s) {
  if (s == 0) return lo;
  if (s == 1) return hi;
  return is_angle ? arc_angle(lo, hi, s) : lo + (hi - lo) * s;
}
double to_patch(bool is_angle, double lo, double hi, double u) {
  return is_angle ? arc_parameter(lo, hi, u) : (u - lo) / (hi - lo);
}

/// Scales pole k by factorᵏ and everything so that the two ends of an arc weigh as before the cut: a
/// projective change of parameter that puts the piece of an arc back into the standard form.
void restore_arc(Vec4* poles, std::size_t stride, double end_ratio, double scale) {
  const double factor = std::sqrt(end_ratio);
  double s = scale;
  for (int k = 0; k < 3; ++k, s *= factor) poles[k * stride] = scaled(poles[k * stride], s);
}

}  // namespace

std::vector<BezierPatch> bezier_patches(const Surface& surface, const Box2& region) {
  if (!(region.lo.x < region.hi.x) || !(region.lo.y < region.hi.y)) return {};
  return std::visit([&](const auto& geometry) { return patches(geometry, region); }, surface.geometry);
}

std::vector<BezierCurve3> bezier_curves(const Curve3& curve, double t0, double t1) {
  if (!(t0 < t1)) return {};
  return std::visit(CurvePieces{t0, t1}, curve.geometry);
}

BezierPatch subpatch(const BezierPatch& patch, double s0, double s1, double t0, double t1) {
  BezierPatch out = patch;
  const int p = patch.degree_u, q = patch.degree_v;
  const std::size_t stride = static_cast<std::size_t>(q + 1);
  const double corner = patch.poles[0].w;
  if (s0 != 0 || s1 != 1) {
    for (int j = 0; j <= q; ++j) keep_piece(&out.poles[j], p, stride, s0, s1);
    out.domain.lo.x = patch_to_surface_u(patch, s0);
    out.domain.hi.x = patch_to_surface_u(patch, s1);
    if (patch.u_is_angle) {
      const double w0 = out.poles[0].w, w2 = out.poles[2 * stride].w;
      for (int j = 0; j <= q; ++j) restore_arc(&out.poles[j], stride, w0 / w2, corner / w0);
    }
  }
  if (t0 != 0 || t1 != 1) {
    for (int i = 0; i <= p; ++i) keep_piece(&out.poles[i * stride], q, 1, t0, t1);
    out.domain.lo.y = patch_to_surface_v(patch, t0);
    out.domain.hi.y = patch_to_surface_v(patch, t1);
    if (patch.v_is_angle) {
      const double w0 = out.poles[0].w, w2 = out.poles[2].w;
      for (int i = 0; i <= p; ++i) restore_arc(&out.poles[i * stride], 1, w0 / w2, corner / w0);
    }
  }
  if (!patch.rational)
    for (Vec4& pole : out.poles) pole.w = 1;
  return out;
}

double patch_to_surface_u(const BezierPatch& patch, double s) {
  return to_surface(patch.u_is_angle, patch.domain.lo.x, patch.domain.hi.x, s);
}
double patch_to_surface_v(const BezierPatch& patch, double t) {
  return to_surface(patch.v_is_angle, patch.domain.lo.y, patch.domain.hi.y, t);
}
double surface_to_patch_u(const BezierPatch& patch, double u) {
  return to_patch(patch.u_is_angle, patch.domain.lo.x, patch.domain.hi.x, u);
}
double surface_to_patch_v(const BezierPatch& patch, double v) {
  return to_patch(patch.v_is_angle, patch.domain.lo.y, patch.domain.hi.y, v);
}

Vec3 point_at(const BezierPatch& patch, double s, double t) {
  std::array<Vec4, kMaxDegree + 1> column, row;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) row[j] = patch.pole(i, j);
    keep_left(row.data(), patch.degree_v, 1, t);
    column[i] = row[patch.degree_v];
  }
  keep_left(column.data(), patch.degree_u, 1, s);
  return projected(column[patch.degree_u]);
}

}  // namespace dupin
