#include "hand_made.h"

namespace dupin::testing {
namespace {

std::array<Vec2, 4> rectangle(double x0, double y0, double x1, double y1) {
  return {Vec2{x0, y0}, Vec2{x1, y0}, Vec2{x1, y1}, Vec2{x0, y1}};
}

/// A rounded square of half-width 1 with corners of radius r, as lines and quarter circles around the
/// reference (0, 0).
void rounded_square(PartDps& part, QuadricDp& dp, double r) {
  const Vec2 corners[4] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  dp.first_line = static_cast<std::uint32_t>(part.lines.size());
  dp.first_arc = static_cast<std::uint32_t>(part.arcs.size());
  for (int i = 0; i < 4; ++i) {
    const Vec2 c = corners[i], next = corners[(i + 1) % 4], before = corners[(i + 3) % 4];
    const Vec2 in = c + (before - c) * (r / 2), out = c + (next - c) * (r / 2);
    part.arcs.push_back({in, c, out, std::sqrt(0.5), true});
    part.lines.push_back({out, next + (c - next) * (r / 2), true});
  }

  dp.lines = 4;
  dp.arcs = 4;
  dp.reference = {0, 0};
  dp.reference_inside = true;
}

}  // namespace

HandMade::HandMade() {
  model.parts.emplace_back();
  model.parts[0].name = "hand-made";
  dps.parts.emplace_back();
}

QuadricDp& HandMade::add(const QuadricDp& dp) {
  Part& part = model.parts[0];
  QuadricDp& added = pieces().dps.emplace_back(dp);
  added.face = static_cast<std::uint32_t>(part.faces.size());
  part.faces.emplace_back();
  for (const Vec2 c : dp.footprint)
    for (const double z : {dp.z_lo, dp.z_hi}) part.box.add(dp.origin + dp.u * c.x + dp.v * c.y + dp.n() * z);
  return added;
}

void HandMade::place(const Affine3& to_world) {
  Instance instance;
  instance.to_world = to_world;
  model.instances.push_back(instance);
}

QuadricDp plane_rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double width, double height) {
  QuadricDp dp;
  dp.origin = origin;
  dp.u = u;
  dp.v = v;
  dp.planar = dp.exact = true;
  dp.footprint = rectangle(-width / 2, -height / 2, width / 2, height / 2);
  dp.feature_sides = 15;
  return dp;
}

QuadricDp whole_cylinder(const Vec3& origin, const Vec3& u, const Vec3& v, double radius, double length) {
  QuadricDp dp;
  dp.origin = origin;
  dp.u = u;
  dp.v = v;
  dp.lambda_v = dp.c = -1 / radius;
  dp.footprint = rectangle(0, -radius, length, radius);
  dp.z_lo = -2 * radius;
  dp.exact = true;
  dp.feature_sides = 2 | 8;
  return dp;
}

QuadricDp whole_sphere(const Vec3& origin, const Vec3& u, const Vec3& v, double radius) {
  QuadricDp dp = whole_cylinder(origin, u, v, radius, 1);
  dp.lambda_u = -1 / radius;
  dp.footprint = rectangle(-radius, -radius, radius, radius);
  dp.feature_sides = 0;
  return dp;
}

QuadricDp whole_cone(PartDps& part, const Vec3& apex, const Vec3& axis, double half_angle, double length) {
  // In the frame at slant distance s along a generator: with X = x + s the cone is
  //     2 X z sin cos + (cos² − sin²) z² + cos² y² = 0.
  const double sine = std::sin(half_angle), cosine = std::cos(half_angle), s = 0.5 * length / cosine;
  const Vec3 side = any_perpendicular(axis);
  QuadricDp dp;
  dp.u = axis * cosine + side * sine;
  const Vec3 n = side * cosine - axis * sine;
  dp.v = cross(n, dp.u);
  dp.origin = apex + dp.u * s;
  dp.lambda_v = -cosine / (s * sine);
  dp.a = -1 / s;
  dp.c = -(cosine * cosine - sine * sine) / (s * sine * cosine);
  const double radius = length * sine / cosine, reach = length / cosine;
  dp.footprint = rectangle(-s, -radius, reach - s, radius);
  dp.z_lo = -2 * radius;
  dp.z_hi = 0;
  dp.exact = true;
  const Vec3 along{cosine, 0, -sine};
  const double at_origin = s * cosine;
  dp.first_plane = static_cast<std::uint32_t>(part.planes.size());
  dp.planes = 2;
  part.planes.push_back({along, at_origin, false});
  part.planes.push_back({-along, length - at_origin, true});
  return dp;
}

QuadricDp bent_square(const Vec3& origin, const Vec3& u, const Vec3& v, double lambda_u, double lambda_v,
                      const Vec3& abc, double half) {
  QuadricDp dp;
  dp.origin = origin;
  dp.u = u;
  dp.v = v;
  dp.lambda_u = lambda_u;
  dp.lambda_v = lambda_v;
  dp.a = abc.x;
  dp.b = abc.y;
  dp.c = abc.z;
  dp.footprint = rectangle(-half, -half, half, half);
  const double height = (std::abs(lambda_u) + std::abs(lambda_v)) * half * half;
  dp.z_lo = -height;
  dp.z_hi = height;
  return dp;
}

Affine3 rigid(const Vec3& axis, double angle, const Vec3& shift) {
  const Vec3 a = normalized(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const Vec3& p) { return p * c + cross(a, p) * s + a * (dot(a, p) * (1 - c)); };
  return {{turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})}, shift};
}

HandMade every_kind() {
  HandMade scene;
  const Vec3 x{1, 0, 0}, y{0, 1, 0};
  QuadricDp plate = plane_rectangle({0, 0, 0}, x, y, 2, 2);
  plate.feature_sides = 0;
  rounded_square(scene.pieces(), plate, 0.5);
  plate.first_ellipse = 0;
  plate.ellipses = 1;
  scene.pieces().ellipses.push_back({{0.1, -0.2}, 1 / 0.35, 0.4, 1 / 0.2, true});
  // The reference is inside the outline, and in the hole: both are folded in.
  plate.reference_inside = true;
  scene.add(plate);
  scene.add(plane_rectangle({0, 0, -0.6}, normalized(Vec3{1, 0.2, 0.1}),
                            normalized(cross(Vec3{0, -0.1, 1}, Vec3{1, 0.2, 0.1})), 2.4, 1.6));
  scene.add(whole_cylinder({-0.9, 0.4, 0.75}, normalized(Vec3{1, 0.3, 0.2}), normalized(Vec3{-0.3, 1, 0}),
                           0.18, 1.1));
  scene.add(whole_sphere({0.55, -0.55, 0.9}, x, y, 0.35));
  scene.add(whole_cone(scene.pieces(), {-0.5, -0.7, 1.0}, normalized(Vec3{0.1, 0.1, -1}), 0.35, 0.8));
  scene.add(bent_square({0.7, 0.6, 0.5}, normalized(Vec3{1, 1, 0.3}),
                        normalized(cross(Vec3{-0.2, -0.1, 1}, Vec3{1, 1, 0.3})), 1.2, -0.8, {0.2, -0.3, 0.4},
                        0.3));
  return scene;
}

HandMade moved(HandMade scene, double scale, const Vec3& shift) {
  PartDps& part = scene.pieces();
  for (QuadricDp& dp : part.dps) {
    dp.origin = dp.origin * scale + shift;
    for (double* curvature : {&dp.lambda_u, &dp.lambda_v, &dp.a, &dp.b, &dp.c}) *curvature /= scale;
    for (Vec2& corner : dp.footprint) corner = corner * scale;
    dp.reference = dp.reference * scale;
    dp.z_lo *= scale, dp.z_hi *= scale;
  }
  for (ClipPlane& plane : part.planes) plane.d *= scale;
  for (LinePiece& line : part.lines) line.p0 = line.p0 * scale, line.p1 = line.p1 * scale;
  for (ArcPiece& arc : part.arcs) arc.p0 = arc.p0 * scale, arc.p1 = arc.p1 * scale, arc.p2 = arc.p2 * scale;
  for (EllipsePiece& e : part.ellipses) {
    e.center = e.center * scale;
    e.mxx /= scale, e.mxy /= scale, e.myy /= scale;
  }
  Box3& box = scene.model.parts[0].box;
  box.lo = box.lo * scale + shift;
  box.hi = box.hi * scale + shift;
  return scene;
}

}  // namespace dupin::testing
