#include "search_domain.h"

#include <cmath>

namespace dupin::reader {
namespace {

constexpr double kInfinite = 1e50;

}  // namespace

Box3 edge_box(const std::vector<Edge>& edges, const std::vector<std::vector<WireEdge>>& wires) {
  Box3 box;
  for (const auto& wire : wires)
    for (const WireEdge& use : wire) {
      const Edge& edge = edges[use.numbers.edge];
      if (!edge.curve) continue;
      for (int i = 0; i <= 16; ++i) {
        const Vec3 p = point_at(*edge.curve, edge.t0 + (edge.t1 - edge.t0) * i / 16);
        if (is_finite(p)) box.add(p);
      }
    }
  return box;
}

Box2 search_domain(const Surface& surface, const std::vector<Edge>& edges,
                   const std::vector<std::vector<WireEdge>>& wires) {
  Box2 whole = domain(surface);
  const Box3 box = edge_box(edges, wires);
  // Along an infinite direction parameters grow with the distance at the partial's rate, which for the
  // unbounded kinds (plane, cylinder, cone, extrusion, a revolved line) is constant.
  const auto within = [](double lo, double hi, double inside) {
    return std::abs(lo) < kInfinite && std::abs(hi) < kInfinite ? (lo + hi) / 2 : inside;
  };
  const double u = within(whole.lo.x, whole.hi.x, 0), v = within(whole.lo.y, whole.hi.y, 0);
  const SurfaceJet s = evaluate(surface, u, v, 1);
  const double reach = distance(s.p, box.center()) + box.diagonal();
  const auto limit = [&](double& lo, double& hi, const Vec3& partial) {
    const double rate = length(partial) > 0 ? length(partial) : 1;
    if (!(std::abs(lo) < kInfinite)) lo = -reach / rate;
    if (!(std::abs(hi) < kInfinite)) hi = reach / rate;
  };
  limit(whole.lo.x, whole.hi.x, s.pu);
  limit(whole.lo.y, whole.hi.y, s.pv);
  return whole;
}

}  // namespace dupin::reader
