#include "part_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../core/parallel.h"

namespace dupin {
namespace {

using Side = EdgeSide;

/// Gaps below this part of the tolerance are not looked at.
constexpr double kNoGap = 2e-3;
/// Below this sine two faces are taken to go on smoothly, and reach this many times what they are off.
constexpr double kSmoothSine = 0.25, kSmoothReach = 4;
/// A straight edge stays straight if its middle moves out of line by no more than this part of what it moves.
constexpr double kStraight = 0.02;
/// A file's edge is taken to be off each of its faces by no more than this many times its tolerance.
constexpr double kMostTolerances = 1;

/// Edge ends joined into vertices: end 2e is where edge e starts, 2e+1 where it stops.
class Vertices {
 public:
  explicit Vertices(std::size_t edges) : parent_(2 * edges) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t end_of(const Trim& trim, bool last) {
  return 2 * trim.edge + (trim.reversed != last ? 1u : 0u);
}

Vec3 end_point(const std::vector<ArcChain>& chains, std::uint32_t end) {
  const auto& arcs = chains[end / 2].arcs;
  return end % 2 == 0 ? arcs.front().p0 : arcs.back().p2;
}

/// How far apart two ends may lie to be one vertex.
double join_distance(const Part& part, const Trim& a, const Trim& b) {
  return 4 *
         std::max({part.edges[a.edge].tolerance, part.edges[b.edge].tolerance, part.box.diagonal() * 1e-7});
}

/// What a point of an edge's chain is moved by, for all faces.
Vec3 to_common_point(const Vec3& p, const Side& a, const Side& b, double most) {
  const double c = dot(a.n, b.n), s2 = 1 - c * c;
  if (!(s2 > kSmoothSine * kSmoothSine)) return {};
  const double ga = dot(a.n, a.p - p), gb = dot(b.n, b.p - p);
  const Vec3 d = (a.n * (ga - c * gb) + b.n * (gb - c * ga)) / s2;
  return length(d) <= most ? d : Vec3{};
}

/// The parabola through three points of the unit ball stays within this.
constexpr double kBetweenThree = 1.25;

/// How far faces with these normals and unit outward directions reach for their sheets to overlap, as a
/// multiple of what both together may be off. Where the other is not known they are taken to meet at a right
/// angle.
double reach_for(const Side& a, const Side& b, const Vec3& out_a, const Vec3& out_b) {
  if (b.n == Vec3{}) return 1;
  const double sine = length(cross(a.n, b.n));
  if (sine > kSmoothSine) return 1.05 / sine;
  return dot(out_a, out_b) < 0 ? kSmoothReach : 1;
}

}  // namespace

void displace(ConicArc3& arc, const std::array<Vec3, 3>& by) {
  arc.p0 += by[0], arc.p2 += by[2];
  // The ends may be exact and the middle off: its displacement d takes p1 along by d (1 + w) / w, less what
  // the ends bring.
  const Vec3 ends = (by[0] + by[2]) * 0.5, bow = by[1] - ends;
  if (arc.line && length(bow) <= kStraight * length(by[1])) return void(arc.p1 += ends);
  if (arc.line)
    arc.line = false, arc.w = 1, arc.p1 = (arc.p0 + arc.p2) * 0.5 + bow * 2;
  else
    arc.p1 += ends + bow * ((1 + arc.w) / arc.w);
}

bool is_drawn_exactly(const Part& part, const Face& face) {
  return is_quadric(face.recognized ? face.recognized->surface : part.surfaces[face.surface]);
}

PartEdges::PartEdges(const Part& part, const LocalTolerance& tolerance)
    : part_(part), chains_(part.edges.size()), moved_(part.edges.size()), planes_(part.edges.size()) {
  find_uses();
  const LocalTolerance of_edges = [&](const Box3& box) { return tolerance(box) * kEdgeTolerance; };
  parallel_for(
      part.edges.size(),
      [&](std::size_t i) {
        chains_[i] = approximate_edge(part.edges[i], of_edges);
        close_edge(static_cast<std::uint32_t>(i), tolerance);
      },
      64);
  join_vertices();
}

std::span<const ArcReach> PartEdges::reach(std::uint32_t face, std::size_t trim) const {
  return reach_[first_trim_[face] + trim];
}

void PartEdges::find_uses() {
  first_use_.assign(part_.edges.size() + 1, 0);
  for (const Face& face : part_.faces)
    for (const Loop& loop : face.loops)
      for (const Trim& trim : loop) ++first_use_[trim.edge + 1];
  std::partial_sum(first_use_.begin(), first_use_.end(), first_use_.begin());
  std::vector<std::uint32_t> next(first_use_.begin(), first_use_.end() - 1);
  uses_.resize(first_use_.back());
  std::uint32_t trims = 0;
  for (std::uint32_t f = 0; f < part_.faces.size(); ++f) {
    first_trim_.push_back(trims);
    for (const Loop& loop : part_.faces[f].loops)
      for (const Trim& trim : loop) uses_[next[trim.edge]++] = {f, trims++, &trim};
  }
  reach_.resize(trims);
}

void PartEdges::note_planes(std::uint32_t end, const EdgeSide& a, const EdgeSide& b) {
  auto& at_ends = planes_[end / 2];
  if (!at_ends) at_ends = std::make_unique<std::array<EndPlanes, 2>>();
  (*at_ends)[end % 2].sides[0] = a, (*at_ends)[end % 2].sides[1] = b;
}

/// The point nearest to `p` on the tangent planes of all faces that meet there, in the least squares' sense.
Vec3 PartEdges::meeting_point(const std::vector<std::uint32_t>& ends, const Vec3& p, double most) const {
  Mat3 m{{}, {}, {}};
  Vec3 r;
  for (std::uint32_t end : ends) {
    if (!planes_[end / 2]) continue;
    for (const EdgeSide& s : (*planes_[end / 2])[end % 2].sides) {
      m.x += s.n * s.n.x, m.y += s.n * s.n.y, m.z += s.n * s.n.z;
      r += s.n * dot(s.n, s.p - p);
    }
  }
  const double ridge = 1e-3 * (m.x.x + m.y.y + m.z.z);
  if (!(ridge > 0)) return p;
  m.x.x += ridge, m.y.y += ridge, m.z.z += ridge;
  const Vec3 by = inverse(m) * r;
  return length(by) <= most ? p + by : p;
}

void PartEdges::join_vertices() {
  Vertices vertices(part_.edges.size());
  std::vector<const Trim*> real;
  for (const Face& face : part_.faces)
    for (const Loop& loop : face.loops) {
      real.clear();
      for (const Trim& trim : loop)
        if (!trim.degenerate && !chains_[trim.edge].arcs.empty()) real.push_back(&trim);
      for (std::size_t i = 0; i < real.size(); ++i) {
        const Trim &a = *real[i], &b = *real[(i + 1) % real.size()];
        const std::uint32_t ea = end_of(a, true), eb = end_of(b, false);
        if (distance(end_point(chains_, ea), end_point(chains_, eb)) <= join_distance(part_, a, b))
          vertices.join(ea, eb);
      }
    }
  std::vector<std::vector<std::uint32_t>> joined;  // those of more than one end, by their lowest
  std::vector<std::uint32_t> set(2 * chains_.size(), 0);
  for (std::uint32_t end = 0; end < 2 * chains_.size(); ++end) {
    const std::uint32_t root = vertices.find(end);
    if (root == end || chains_[end / 2].arcs.empty()) continue;
    if (set[root] == 0) joined.push_back({root}), set[root] = static_cast<std::uint32_t>(joined.size());
    joined[set[root] - 1].push_back(end);
  }
  for (const auto& ends : joined) {
    double most = 0;
    for (std::uint32_t end : ends) most = std::max(most, 4 * part_.edges[end / 2].tolerance);
    const Vec3 vertex = meeting_point(ends, end_point(chains_, ends[0]), most);
    for (std::uint32_t end : ends)
      (end % 2 == 0 ? chains_[end / 2].arcs.front().p0 : chains_[end / 2].arcs.back().p2) = vertex;
  }
}

namespace {

/// What one edge's faces are at a point of it, and what follows.
class Closing {
 public:
  Closing(const Part& part, const Edge& edge) : part_(part), edge_(edge) {}

  void add(const Face& face, const Trim& trim, double off) {
    if (count_ < 2) sides_[count_] = {&face, &trim, off};
    ++count_;
  }

  struct Result {
    Vec3 common;
    Vec3 outward[2];
    double own = 0;
    Side side[2];
    bool gap = false;
  };
  /// At the edge's parameter t; `p` is the chain's point there, `along` the edge's direction.
  Result at(double t, const Vec3& p, const Vec3& along, double chain_off, double no_gap) const {
    Result result;
    Side* side = result.side;
    for (int k = 0; k < count_; ++k) side[k] = side_at(k, t);
    if (count_ == 1) side[1] = {p, {}, side[0].off};
    const double most = kMostTolerances * edge_.tolerance;
    double gap = std::min(distance(side[0].p, p), most) + std::min(distance(side[1].p, p), most);
    if (gap <= no_gap) gap = 0;
    result.gap = gap > 0;
    if (gap > 0 && count_ == 2) {
      result.common = to_common_point(p, side[0], side[1], 4 * most);
      if (result.common != Vec3{}) gap = 0;
    }
    const double own = side[0].off + side[1].off + 2 * chain_off;
    if (!(own + gap > 0)) return result;
    Vec3 out[2];
    for (int k = 0; k < count_; ++k)  // the face lies to the left of its loops in (u,v): outwards is T × n
      out[k] = normalized(cross(along, side[k].n)) * (sides_[k].trim->reversed ? -1.0 : 1.0);
    const double times = reach_for(side[0], side[1], out[0], out[1]);
    for (int k = 0; k < count_; ++k) result.outward[k] = out[k] * (times * (own + gap));
    result.own = times * own;
    return result;
  }

 private:
  struct Of {
    const Face* face;
    const Trim* trim;
    double off;
  };
  Side side_at(int k, double t) const {
    const Vec2 uv = point_at(sides_[k].trim->pcurve, t);
    const SurfaceJet jet = evaluate(part_.surfaces[sides_[k].face->surface], uv.x, uv.y, 1);
    const Vec3 n = cross(jet.pu, jet.pv);
    const bool regular = length(n) > 1e-9 * length(jet.pu) * length(jet.pv);
    return {jet.p, regular ? normalized(n) : Vec3{}, sides_[k].off};
  }
  const Part& part_;
  const Edge& edge_;
  Of sides_[2] = {};
  int count_ = 0;
};

}  // namespace

void PartEdges::close_edge(std::uint32_t edge, const LocalTolerance& tolerance) {
  const auto& arcs = chains_[edge].arcs;
  const auto used = uses(edge);
  if (arcs.empty() || used.empty()) return;
  const bool within_one = used.size() > 1 && used[0].face == used[1].face;
  if (within_one && used[0].as->seam) return;
  // More than two faces in an edge: each as if it were alone, with what it meets unknown.
  const std::size_t together = used.size() == 2 ? 2 : 1;
  for (std::size_t first = 0; first < used.size(); first += together)
    close_between(edge, used.subspan(first, together), tolerance);
}

void PartEdges::close_between(std::uint32_t edge, std::span<const Use> used,
                              const LocalTolerance& tolerance) {
  const Edge& e = part_.edges[edge];
  auto& arcs = chains_[edge].arcs;
  bool approximated = used.size() == 1;
  for (const Use& use : used) approximated |= !is_drawn_exactly(part_, part_.faces[use.face]);
  std::vector<Vec3> common(3 * arcs.size());
  bool moves = false;
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const ConicArc3& arc = arcs[k];
    const double allowed = tolerance(bounding_box(arc)), no_gap = kNoGap * allowed;
    if (std::isinf(allowed)) continue;
    if (!approximated && arc.deviation <= no_gap && kMostTolerances * e.tolerance <= no_gap) continue;
    Closing closing(part_, e);
    for (const Use& use : used) {
      const bool exact = used.size() == 2 && is_drawn_exactly(part_, part_.faces[use.face]);
      closing.add(part_.faces[use.face], *use.as, exact ? 0 : allowed * kTrimTolerance);
      reach_[use.trim].resize(arcs.size());
    }
    const double middle = (arc.t0 + arc.t1) / 2;
    const Vec3 points[3] = {arc.p0, point_at(*e.curve, middle), arc.p2};
    const Vec3 shoulder = arc.line ? (arc.p0 + arc.p2) * 0.5 : arc.p1;
    const Vec3 along[3] = {shoulder - arc.p0, arc.p2 - arc.p0, arc.p2 - shoulder};
    const double at[3] = {arc.t0, middle, arc.t1};
    for (int i = 0; i < 3; ++i) {
      const Closing::Result r = closing.at(at[i], points[i], along[i], arc.deviation, no_gap);
      common[3 * k + i] = r.common;
      moves |= r.common != Vec3{};
      const bool first = k == 0 && i == 0, last = k + 1 == arcs.size() && i == 2;
      if (r.gap && (first || last)) note_planes(2 * edge + (last ? 1 : 0), r.side[0], r.side[1]);
      for (std::size_t u = 0; u < used.size(); ++u) {
        ArcReach& reach = reach_[used[u].trim][k];
        reach.by[static_cast<std::size_t>(i)] = r.outward[u];
        reach.own = std::max(reach.own, kBetweenThree * r.own);
      }
    }
  }
  if (!moves) return;
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    // Where arcs meet both give the same point the same displacement, but for what their tolerances differ.
    const Vec3 first = k > 0 ? common[3 * k - 1] : common[0], last = common[3 * k + 2];
    displace(arcs[k], {first, common[3 * k + 1], last});
    if (k > 0) arcs[k].p0 = arcs[k - 1].p2;
    for (int i = 0; i < 3; ++i) moved_[edge] = std::max(moved_[edge], length(common[3 * k + i]));
  }
}

}  // namespace dupin
