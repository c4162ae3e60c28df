#include "surface.h"

#include <array>
#include <numbers>

#include "jets.h"

namespace dupin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2 * std::numbers::pi;

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};

}  // namespace

void evaluate_into(const Surface& surface, double u, double v, int order, Vec3* out, Sides sides) {
  std::visit([&](const auto& geometry) { evaluate_into(geometry, u, v, order, out, sides); },
             surface.geometry);
}

SurfaceJet evaluate(const Surface& surface, double u, double v, int order, Sides sides) {
  order = std::clamp(order, 0, 3);
  Vec3 d[jet_size(3)];
  evaluate_into(surface, u, v, order, d, sides);
  return {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8], d[9]};
}

std::string_view kind_name(const Surface& surface) {
  static constexpr std::array<std::string_view, 9> kNames = {
      "plane", "cylinder", "cone", "sphere", "torus", "bspline", "revolution", "extrusion", "offset"};
  return kNames[surface.geometry.index()];
}

bool is_quadric(const Surface& surface) {
  return surface.geometry.index() < 4;
}

Box2 domain(const Surface& surface) {
  const Overloaded visitor{[](const Plane&) {
                             return Box2{{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
                           },
                           [](const Cylinder&) {
                             return Box2{{0, -kInfinity}, {kTurn, kInfinity}};
                           },
                           [](const Cone&) {
                             return Box2{{0, -kInfinity}, {kTurn, kInfinity}};
                           },
                           [](const Sphere&) {
                             return Box2{{0, -kTurn / 4}, {kTurn, kTurn / 4}};
                           },
                           [](const Torus&) {
                             return Box2{{0, 0}, {kTurn, kTurn}};
                           },
                           [](const BsplineSurface& s) {
                             return Box2{{s.knots_u[s.degree_u], s.knots_v[s.degree_v]},
                                         {s.knots_u[s.count_u], s.knots_v[s.count_v]}};
                           },
                           [](const Revolution& s) {
                             const ParameterRange v = domain(s.profile);
                             return Box2{{0, v.lo}, {kTurn, v.hi}};
                           },
                           [](const Extrusion& s) {
                             const ParameterRange u = domain(s.profile);
                             return Box2{{u.lo, -kInfinity}, {u.hi, kInfinity}};
                           },
                           [](const OffsetSurface& s) { return domain(*s.base); }};
  return std::visit(visitor, surface.geometry);
}

double period_u(const Surface& surface) {
  const Overloaded visitor{[](const Plane&) { return 0.0; },
                           [](const BsplineSurface& s) {
                             return s.periodic_u ? s.knots_u[s.count_u] - s.knots_u[s.degree_u] : 0.0;
                           },
                           [](const Extrusion& s) { return period(s.profile); },
                           [](const OffsetSurface& s) { return period_u(*s.base); },
                           [](const auto&) { return kTurn; }};
  return std::visit(visitor, surface.geometry);
}

double period_v(const Surface& surface) {
  const Overloaded visitor{[](const Torus&) { return kTurn; },
                           [](const BsplineSurface& s) {
                             return s.periodic_v ? s.knots_v[s.count_v] - s.knots_v[s.degree_v] : 0.0;
                           },
                           [](const Revolution& s) { return period(s.profile); },
                           [](const OffsetSurface& s) { return period_v(*s.base); },
                           [](const auto&) { return 0.0; }};
  return std::visit(visitor, surface.geometry);
}

}  // namespace dupin
