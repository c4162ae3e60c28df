#include "edge_tubes.h"

#include <cmath>

namespace dupin::exact {
namespace {

constexpr double kStraight = 0.02;  // of a piece's chord
constexpr int kFewestCuts = 2, kMostCuts = 12, kSearchSteps = 60;
/// In radii of the tube, on a face that the line does not graze, and how much grazing counts.
constexpr double kReach = 16, kLeastCosine = 0.02;

Box3 grown(Box3 box, double by) {
  box.lo -= Vec3{by, by, by};
  box.hi += Vec3{by, by, by};
  return box;
}

}  // namespace

EdgeTubes::EdgeTubes(const Part& part) : part_(part), uses_(part.edges.size()) {
  for (std::uint32_t f = 0; f < part.faces.size(); ++f)
    for (const Loop& loop : part.faces[f].loops)
      for (const Trim& trim : loop)
        if (Use& use = uses_[trim.edge]; ++use.count == 1) use.face = f, use.trim = &trim;
  std::vector<Box3> boxes;
  for (std::uint32_t e = 0; e < part.edges.size(); ++e)
    if (const Edge& edge = part.edges[e]; edge.curve && edge.tolerance > 0 && uses_[e].count > 1)
      cut(e, edge.t0, edge.t1, 0, boxes);
  bvh_ = Bvh(boxes);
}

void EdgeTubes::cut(std::uint32_t e, double t0, double t1, int depth, std::vector<Box3>& boxes) {
  const Curve3& curve = *part_.edges[e].curve;
  const double middle = 0.5 * (t0 + t1);
  const Vec3 a = point_at(curve, t0), b = point_at(curve, t1), m = point_at(curve, middle);
  const double chord = distance(a, b), sagitta = distance(m, 0.5 * (a + b));
  if (depth < kFewestCuts || (depth < kMostCuts && sagitta > kStraight * chord)) {
    cut(e, t0, middle, depth + 1, boxes);
    cut(e, middle, t1, depth + 1, boxes);
    return;
  }
  Box3 box;
  for (const Vec3& p : {a, b, m}) box.add(p);
  boxes.push_back(grown(box, part_.edges[e].tolerance + 2 * sagitta));
  pieces_.push_back({e, t0, t1});
}

bool EdgeTubes::passes(const Line& line, const Piece& piece, Passage& passage) const {
  const Edge& edge = part_.edges[piece.edge];
  const double dd = dot(line.direction, line.direction);
  const auto along = [&](const Vec3& p) { return dot(p - line.origin, line.direction) / dd; };
  const auto off = [&](double t) {
    const Vec3 p = point_at(*edge.curve, t);
    return length(p - line.origin - line.direction * along(p));
  };
  // A nearly straight piece has one nearest point: golden section.
  constexpr double kGolden = 0.6180339887498949;
  double lo = piece.t0, hi = piece.t1, x = hi - kGolden * (hi - lo), y = lo + kGolden * (hi - lo);
  double at_x = off(x), at_y = off(y);
  for (int step = 0; step < kSearchSteps && std::min(at_x, at_y) > edge.tolerance; ++step) {
    if (at_x < at_y) {
      hi = y, y = x, at_y = at_x;
      x = hi - kGolden * (hi - lo), at_x = off(x);
    } else {
      lo = x, x = y, at_x = at_y;
      y = lo + kGolden * (hi - lo), at_y = off(y);
    }
  }
  if (std::min(at_x, at_y) > edge.tolerance) return false;
  const double nearest = at_x < at_y ? x : y;
  const Use& use = uses_[piece.edge];
  const Surface& surface = part_.surfaces[part_.faces[use.face].surface];
  passage.t = along(point_at(*edge.curve, nearest));
  passage.face = use.face;
  passage.uv = point_at(use.trim->pcurve, nearest);
  const SurfaceJet jet = evaluate(surface, passage.uv.x, passage.uv.y, 1);
  const double speed = std::sqrt(dd);
  const double cosine = std::abs(dot(normalized(cross(jet.pu, jet.pv)), line.direction)) / speed;
  passage.reach = kReach * edge.tolerance / std::max(cosine, kLeastCosine) / speed;
  return true;
}

void EdgeTubes::traverse(const Line& line, double least, double most,
                         const std::function<void(const Passage&)>& visit) const {
  bvh_.traverse(line, least, most, [&](std::uint32_t i) {
    Passage passage;
    if (passes(line, pieces_[i], passage) && passage.t >= least && passage.t <= most) visit(passage);
    return most;
  });
}

}  // namespace dupin::exact
