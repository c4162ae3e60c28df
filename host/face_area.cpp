#include "face_area.h"

#include <cmath>

namespace dupin {
namespace {

constexpr int kPieces = 8;
/// Gauss and Legendre's nodes and weights on [-1, 1], of order 5.
constexpr double kNodes[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                             0.9061798459386640};
constexpr double kWeights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                               0.2369268850561891};

template <class F>
double integral(double from, double to, F&& value) {
  const double half = 0.5 * (to - from) / kPieces;
  double sum = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const double middle = from + (2 * piece + 1) * half;
    for (int i = 0; i < 5; ++i) sum += kWeights[i] * value(middle + half * kNodes[i]);
  }
  return sum * half;
}

}  // namespace

double face_area(const Part& part, const Face& face) {
  const Surface& surface = part.surfaces[face.surface];
  const Box2& box = face.uv_box;
  /// ∫ |Su × Sv| ds from the box's side to u: its contour integral ∮ … dv is the area.
  const auto strip = [&](double u, double v) {
    return integral(box.lo.x, u, [&](double s) {
      const SurfaceJet jet = evaluate(surface, s, v, 1);
      const double density = length(cross(jet.pu, jet.pv));
      return std::isfinite(density) ? density : 0.0;
    });
  };
  if (face.loops.empty()) return integral(box.lo.y, box.hi.y, [&](double v) { return strip(box.hi.x, v); });
  double area = 0;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      const double along = integral(edge.t0, edge.t1, [&](double t) {
        const auto jet = evaluate(trim.pcurve, t, 1);
        return jet[1].y == 0 ? 0.0 : strip(jet[0].x, jet[0].y) * jet[1].y;
      });
      area += trim.reversed ? -along : along;
    }
  return std::abs(area);
}

}  // namespace dupin
