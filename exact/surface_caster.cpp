#include "surface_caster.h"

#include <cmath>

#include "../nurbs/bounds.h"

namespace dupin::exact {
namespace {

constexpr int kPolishSteps = 20;

bool is_analytic(const Surface& surface) {
  return is_quadric(surface) || std::holds_alternative<Torus>(surface.geometry);
}

}  // namespace

bool polish(const Surface& surface, const Line& line, const Box2& limits, double tolerance,
            Crossing& crossing) {
  const LinePlanes planes(line.direction);
  const Vec2 margin = limits.size() * 1e-6;
  Vec2 uv = crossing.uv, best = uv;
  double least = INFINITY;
  for (int step = 0; step < kPolishSteps; ++step) {
    const SurfaceJet jet = evaluate(surface, uv.x, uv.y, 1);
    const Vec3 d = jet.p - line.origin;
    const Vec2 off{dot(planes.a, d), dot(planes.b, d)};
    const double distance = length(off);
    if (!(distance < least)) break;
    least = distance;
    best = uv;
    const Vec2 fu{dot(planes.a, jet.pu), dot(planes.b, jet.pu)},
        fv{dot(planes.a, jet.pv), dot(planes.b, jet.pv)};
    const double det = cross(fu, fv);
    if (det == 0) break;
    uv = {uv.x - cross(off, fv) / det, uv.y - cross(fu, off) / det};
    if (!(uv.x >= limits.lo.x - margin.x && uv.x <= limits.hi.x + margin.x &&
          uv.y >= limits.lo.y - margin.y && uv.y <= limits.hi.y + margin.y))
      break;
  }
  if (!(least <= tolerance)) return false;
  crossing.uv = best;
  crossing.t = dot(point_at(surface, best.x, best.y) - line.origin, line.direction) /
               dot(line.direction, line.direction);
  return true;
}

std::unique_ptr<SurfaceCaster> make_caster(const Surface& surface, const Box2& region) {
  if (is_analytic(surface)) return make_analytic_caster(surface, region);
  std::vector<BezierPatch> patches = bezier_patches(surface, region);
  for (const BezierPatch& patch : patches)
    for (const Vec4& pole : patch.poles)
      if (!(pole.w > 0)) return make_sampled_caster(surface, region);
  if (patches.empty()) return make_sampled_caster(surface, region);
  return make_patch_caster(surface, std::move(patches));
}

}  // namespace dupin::exact
