#include "kinds.h"

#include <memory>

#include "random_geometry.h"

namespace dupin::testing {
namespace {

Curve3 offset_of(Curve3 base, double distance, const Vec3& reference) {
  return {OffsetCurveOf<Vec3>{std::make_shared<const Curve3>(std::move(base)), distance, reference}};
}

struct Profile {
  std::string name;
  Curve3 curve;
  double t0, t1;
};

/// In the half plane x > 0 of the frame's xz plane.
std::vector<Profile> profiles(const Frame3& f, bool rational_only) {
  Random random(21);
  const Vec3 center = f.to_world({3, 0, 0.5});
  Bspline3 spline = random_curve(random, 3, 3, true, false);
  for (Vec3& p : spline.poles) p = center + f.x * p.x + f.z * p.y + f.y * (0.1 * p.z);
  std::vector<Profile> out = {{"line", {LineOf<Vec3>{center, normalized(f.x + f.z * 2)}}, -1, 1.5},
                              {"circle", {CircleOf<Vec3>{center, f.x, f.z, 0.7}}, 0.3, 5},
                              {"ellipse", {EllipseOf<Vec3>{center, f.z, f.x, 1.1, 0.4}}, -1, 1.2},
                              {"parabola", {ParabolaOf<Vec3>{center, f.x, f.z, 0.8}}, -1, 1.3},
                              {"spline", {spline}, 0, 1}};
  if (rational_only) return out;
  out.push_back({"hyperbola", {HyperbolaOf<Vec3>{center, f.x, f.z, 0.5, 0.6}}, -0.7, 0.9});
  out.push_back({"offset circle", offset_of({CircleOf<Vec3>{center, f.x, f.z, 0.7}}, 0.2, f.y), 0.3, 2});
  return out;
}

}  // namespace

std::vector<Sample> analytic_samples() {
  Random random(1);
  std::vector<Sample> out;
  for (const bool left_handed : {false, true}) {
    const Frame3 f = random.frame(left_handed);
    const std::string hand = left_handed ? ", left-handed" : "";
    out.push_back({"plane" + hand, {Plane{f}}, {{-1, -2}, {2, 1}}});
    out.push_back({"cylinder" + hand, {Cylinder{f, 1.3}}, {{0.2, -1}, {6, 2}}});
    out.push_back({"cone" + hand, {Cone{f, 1.5, 0.4}}, {{-1, -1}, {2, 2}}});
    out.push_back({"narrowing cone" + hand, {Cone{f, 1.5, -0.4}}, {{-1, -1}, {2, 2}}});
    out.push_back({"sphere" + hand, {Sphere{f, 1.7}}, {{0, -1.4}, {5, 1.5}}});
    out.push_back({"torus" + hand, {Torus{f, 2.5, 0.8}}, {{0.5, 0}, {6.5, 6}}});
    out.push_back({"spindle torus" + hand, {Torus{f, 0.5, 0.8}}, {{0.5, -1}, {6.5, 1}}});
  }
  return out;
}

std::vector<Sample> swept_samples(bool rational_only) {
  Random random(2);
  const Frame3 f = random.frame();
  std::vector<Sample> out;
  for (const Profile& p : profiles(f, rational_only)) {
    out.push_back(
        {"revolution of a " + p.name, {Revolution{f.origin, f.z, p.curve}}, {{-0.5, p.t0}, {5.5, p.t1}}});
    out.push_back({"extrusion of a " + p.name,
                   {Extrusion{p.curve, normalized(f.y + f.x * 0.3)}},
                   {{p.t0, -2}, {p.t1, 1}}});
  }
  return out;
}

std::vector<Sample> offset_samples() {
  Random random(3);
  const Frame3 f = random.frame(true);
  const auto offset = [](const Surface& base, double distance) {
    return Surface{OffsetSurface{std::make_shared<const Surface>(base), distance}};
  };
  const Surface torus{Torus{f, 2.5, 0.8}},
      spline{random_surface(random, {.degree_u = 4, .extra_u = 2, .rational = true})};
  const Surface extrusion = swept_samples(true).back().surface;
  return {{"offset of a torus", offset(torus, 0.3), {{0.5, 0}, {6.5, 6}}},
          {"offset of a spline", offset(spline, -0.05), {{0, 0}, {1, 1}}},
          {"offset of an extrusion", offset(extrusion, 0.05), {{0, -1}, {1, 1}}},
          {"offset of an offset", offset(offset(torus, 0.3), -0.2), {{0.5, 0}, {6.5, 6}}}};
}

}  // namespace dupin::testing
