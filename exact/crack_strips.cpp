#include "crack_strips.h"

#include <cmath>

namespace dupin::exact {
namespace {

constexpr int kSamples = 16;        // of an edge, to see whether there is a crack
constexpr double kClosed = 1e-13;   // of the coordinates: no crack but rounding
constexpr double kStraight = 0.02;  // of a piece's chord
constexpr int kFewestCuts = 3, kMostCuts = 12, kSteps = 4, kSearchSteps = 60;

/// A strip's two ends at t, seen along the line.
struct Ends {
  Vec2 a, b;
  /// Zero where the line, at the origin, lies in the segment's direction; a change of sign is a crossing.
  double side() const { return cross(a, b); }
};

}  // namespace

CrackStrips::CrackStrips(const Part& part) : part_(part) {
  std::vector<std::vector<Use>> uses(part.edges.size());
  for (std::uint32_t f = 0; f < part.faces.size(); ++f)
    for (const Loop& loop : part.faces[f].loops)
      for (const Trim& trim : loop)
        if (!trim.degenerate) uses[trim.edge].push_back({f, &trim});
  std::vector<Box3> boxes;
  for (std::uint32_t e = 0; e < uses.size(); ++e) {
    for (std::size_t i = 1; i < uses[e].size(); ++i) add({e, uses[e][i - 1], uses[e][i]}, boxes);
    if (uses[e].size() == 1 && part.edges[e].curve) add({e, uses[e][0], {}}, boxes);
  }
  bvh_ = Bvh(boxes);
}

Vec3 CrackStrips::image(const Use& use, double t) const {
  const Vec2 uv = point_at(use.trim->pcurve, t);
  return point_at(part_.surfaces[part_.faces[use.face].surface], uv.x, uv.y);
}

Vec3 CrackStrips::end(const Strip& strip, double t) const {
  return strip.to.trim ? image(strip.to, t) : point_at(*part_.edges[strip.edge].curve, t);
}

void CrackStrips::add(const Strip& strip, std::vector<Box3>& boxes) {
  const Edge& edge = part_.edges[strip.edge];
  double width = 0, size = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double t = edge.t0 + (edge.t1 - edge.t0) * (i + 0.5) / kSamples;
    const Vec3 a = image(strip.from, t);
    width = std::max(width, distance(a, end(strip, t)));
    size = std::max(size, length(a));
  }
  if (!(width > kClosed * size && std::isfinite(width))) return;
  strips_.push_back(strip);
  cut(static_cast<std::uint32_t>(strips_.size() - 1), edge.t0, edge.t1, 0, boxes);
}

void CrackStrips::cut(std::uint32_t index, double t0, double t1, int depth, std::vector<Box3>& boxes) {
  const Strip& strip = strips_[index];
  const double middle = 0.5 * (t0 + t1);
  const Vec3 a = image(strip.from, t0), b = image(strip.from, t1), m = image(strip.from, middle);
  const double sagitta = distance(m, 0.5 * (a + b));
  if (depth < kFewestCuts || (depth < kMostCuts && sagitta > kStraight * distance(a, b))) {
    cut(index, t0, middle, depth + 1, boxes);
    cut(index, middle, t1, depth + 1, boxes);
    return;
  }
  Box3 box;
  for (const Vec3& p : {a, b, m, end(strip, t0), end(strip, t1), end(strip, middle)}) box.add(p);
  const Vec3 spare = Vec3{1, 1, 1} * (2 * sagitta);
  boxes.push_back({box.lo - spare, box.hi + spare});
  pieces_.push_back({index, t0, t1});
}

void CrackStrips::meet(const Line& line, const Piece& piece,
                       const std::function<void(const Crossing&)>& visit) const {
  const Strip& strip = strips_[piece.strip];
  const LinePlanes planes(line.direction);
  const auto seen = [&](const Vec3& p) {
    return Vec2{dot(planes.a, p - line.origin), dot(planes.b, p - line.origin)};
  };
  const auto ends = [&](double t) { return Ends{seen(image(strip.from, t)), seen(end(strip, t))}; };
  double lo = piece.t0;
  bool lo_side = ends(lo).side() > 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double next = i < kSteps ? piece.t0 + (piece.t1 - piece.t0) * i / kSteps : piece.t1;
    const bool side = ends(next).side() > 0;
    if (side != lo_side) {
      double a = lo, b = next;
      for (int step = 0; step < kSearchSteps; ++step) {
        const double middle = 0.5 * (a + b);
        ((ends(middle).side() > 0) == lo_side ? a : b) = middle;
      }
      const Ends at = ends(a);
      const double length_a = length(at.a), length_b = length(at.b);
      if (dot(at.a, at.b) <= 0 && length_a + length_b > 0) {
        const Vec3 p = image(strip.from, a) +
                       (end(strip, a) - image(strip.from, a)) * (length_a / (length_a + length_b));
        visit({dot(p - line.origin, line.direction) / dot(line.direction, line.direction), strip.from.face,
               point_at(strip.from.trim->pcurve, a)});
      }
    }
    lo = next;
    lo_side = side;
  }
}

void CrackStrips::traverse(const Line& line, double least, double most,
                           const std::function<void(const Crossing&)>& visit) const {
  bvh_.traverse(line, least, most, [&](std::uint32_t i) {
    meet(line, pieces_[i], [&](const Crossing& crossing) {
      if (crossing.t >= least && crossing.t <= most) visit(crossing);
    });
    return most;
  });
}

}  // namespace dupin::exact
