#include "boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
/// Polygon sides a flattened pcurve has for each arc of its edge.
constexpr int kUvSidesPerArc = 8;

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

void join_vertices(const Part& part, const std::vector<ArcChain>& chains, Vertices& vertices) {
  std::vector<const Trim*> real;
  for (const Face& face : part.faces)
    for (const Loop& loop : face.loops) {
      real.clear();
      for (const Trim& trim : loop)
        if (!trim.degenerate && !chains[trim.edge].arcs.empty()) real.push_back(&trim);
      for (std::size_t i = 0; i < real.size(); ++i) {
        const Trim &a = *real[i], &b = *real[(i + 1) % real.size()];
        const std::uint32_t ea = end_of(a, true), eb = end_of(b, false);
        if (distance(end_point(chains, ea), end_point(chains, eb)) <= join_distance(part, a, b))
          vertices.join(ea, eb);
      }
    }
}

bool whole_turn(const Edge& edge) {
  return std::abs(edge.t1 - edge.t0 - kTwoPi) < 1e-9;
}

bool whole_ellipse(const Edge& edge, WholeEllipse& out) {
  if (!edge.curve || !whole_turn(edge)) return false;
  out.feature = !edge.smooth;
  if (const auto* c = std::get_if<CircleOf<Vec3>>(&edge.curve->geometry)) {
    out.center = c->center, out.x = c->x * c->radius, out.y = c->y * c->radius;
    return true;
  }
  if (const auto* e = std::get_if<EllipseOf<Vec3>>(&edge.curve->geometry)) {
    out.center = e->center, out.x = e->x * e->major, out.y = e->y * e->minor;
    return true;
  }
  return false;
}

ConicArc3 reversed(ConicArc3 arc) {
  std::swap(arc.p0, arc.p2);
  return arc;
}

/// The pcurve over [t0, t1] as polygon points after the first, and their box.
void flatten(const Trim& trim, double t0, double t1, bool backwards, std::vector<Vec2>& points, Box2& box) {
  const bool straight = std::holds_alternative<LineOf<Vec2>>(trim.pcurve.geometry);
  const int sides = straight ? 1 : kUvSidesPerArc;
  for (int i = 0; i <= sides; ++i) {
    const double s = static_cast<double>(backwards ? sides - i : i) / sides;
    const Vec2 p = point_at(trim.pcurve, t0 + (t1 - t0) * s);
    box.add(p);
    if (i > 0 || points.empty()) points.push_back(p);
  }
  if (!straight) {
    // The curve bulges out of its polygon by about a 64th of its sagitta; the whole box's width is ample.
    const Vec2 margin = box.size() * (1.0 / 32);
    box.lo = box.lo - margin, box.hi = box.hi + margin;
  }
}

/// What a trim's curve in space and its pcurve on the surface are apart, as a displacement outwards along the
/// surface.
class Widening {
 public:
  Widening(const Surface& surface, const Trim& trim, const Edge& edge)
      : surface_(surface), trim_(trim), edge_(edge) {}

  /// At the edge's parameter t, whose point in space is p; `along` is the loop's direction there.
  Vec3 at(double t, const Vec3& p, const Vec3& along) const {
    const Vec2 uv = point_at(trim_.pcurve, t);
    const SurfaceJet jet = evaluate(surface_, uv.x, uv.y, 1);
    const double gap = std::min(distance(jet.p, p), 2 * edge_.tolerance);
    if (!(gap > kNoGap * (1 + length(p)))) return {};
    // The face lies to the left of its loops in (u,v): outwards is T × n.
    return normalized(cross(along, cross(jet.pu, jet.pv))) * gap;
  }

 private:
  static constexpr double kNoGap = 1e-11;
  const Surface& surface_;
  const Trim& trim_;
  const Edge& edge_;
};

void append_trim(const Part& part, const Face& face, const Trim& trim, const std::vector<ArcChain>& chains,
                 bool with_uv, FaceLoop& loop, std::vector<Vec2>& polygon,
                 std::vector<std::array<Vec3, 3>>& outward) {
  const Edge& edge = part.edges[trim.edge];
  const Surface& surface = part.surfaces[face.surface];
  const bool seam = is_inner_seam(face, trim);
  const auto& arcs = chains[trim.edge].arcs;
  if (arcs.empty() || trim.degenerate) {
    Box2 box;
    if (with_uv) flatten(trim, edge.t0, edge.t1, trim.reversed, polygon, box);
    return;
  }
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const ConicArc3& arc = arcs[trim.reversed ? arcs.size() - 1 - k : k];
    FaceArc face_arc{trim.reversed ? reversed(arc) : arc, !edge.smooth, {}};
    if (with_uv) flatten(trim, arc.t0, arc.t1, trim.reversed, polygon, face_arc.uv);
    if (seam) continue;
    loop.arcs.push_back(face_arc);
    const ConicArc3& a = face_arc.arc;
    const Vec3 middle = a.line ? (a.p0 + a.p2) * 0.5 : a.p1;
    const Widening widening(surface, trim, edge);
    outward.push_back({widening.at(trim.reversed ? a.t1 : a.t0, a.p0, middle - a.p0),
                       widening.at((a.t0 + a.t1) / 2, point_at(*edge.curve, (a.t0 + a.t1) / 2), a.p2 - a.p0),
                       widening.at(trim.reversed ? a.t0 : a.t1, a.p2, a.p2 - middle)});
  }
}

/// Files are exact to a tolerance: an edge may lie off both its faces, and its projections onto them apart.
/// Each face reaches out by as much as the edge is off it, so that no crack shows however near one looks.
/// Arcs stay joined.
void reach_over_gaps(FaceLoop& loop, const std::vector<std::array<Vec3, 3>>& outward) {
  const std::size_t n = loop.arcs.size();
  if (n < 2 || outward.size() != n) return;
  std::vector<Vec3> joint(n);  // where arc i ends
  for (std::size_t i = 0; i < n; ++i) joint[i] = (outward[i][2] + outward[(i + 1) % n][0]) * 0.5;
  for (std::size_t i = 0; i < n; ++i) {
    ConicArc3& arc = loop.arcs[i].arc;
    const Vec3 &first = joint[(i + n - 1) % n], &last = joint[i];
    arc.p0 += first, arc.p2 += last;
    // The ends may be exact and the middle off: its displacement d takes p1 along by d (1 + w) / w, less what
    // the ends bring.
    const Vec3 ends = (first + last) * 0.5, bow = outward[i][1] - ends;
    if (arc.line && bow == Vec3{}) continue;
    if (arc.line)
      arc.line = false, arc.w = 1, arc.p1 = (arc.p0 + arc.p2) * 0.5 + bow * 2;
    else
      arc.p1 += ends + bow * ((1 + arc.w) / arc.w);
  }
}

/// Consecutive arcs whose ends are not one vertex get a straight piece between them: a loop is closed
/// whatever the file's gaps.
void close_gaps(FaceLoop& loop) {
  std::vector<FaceArc> closed;
  for (std::size_t i = 0; i < loop.arcs.size(); ++i) {
    closed.push_back(loop.arcs[i]);
    const FaceArc& next = loop.arcs[(i + 1) % loop.arcs.size()];
    const Vec3 a = loop.arcs[i].arc.p2, b = next.arc.p0;
    if (a == b) continue;
    FaceArc gap;
    gap.arc = {a, (a + b) * 0.5, b, 1, true, 0, 0};
    gap.uv = loop.arcs[i].uv;
    gap.uv.add(next.uv.lo), gap.uv.add(next.uv.hi);
    closed.push_back(gap);
  }
  loop.arcs = std::move(closed);
}

}  // namespace

std::vector<ArcChain> part_edge_chains(const Part& part, const LocalTolerance& tolerance) {
  std::vector<ArcChain> chains(part.edges.size());
  parallel_for(
      part.edges.size(), [&](std::size_t i) { chains[i] = approximate_edge(part.edges[i], tolerance); }, 64);
  Vertices vertices(part.edges.size());
  join_vertices(part, chains, vertices);
  for (std::uint32_t end = 0; end < 2 * chains.size(); ++end) {
    const std::uint32_t root = vertices.find(end);
    if (root == end || chains[end / 2].arcs.empty()) continue;
    const Vec3 vertex = end_point(chains, root);
    (end % 2 == 0 ? chains[end / 2].arcs.front().p0 : chains[end / 2].arcs.back().p2) = vertex;
  }
  return chains;
}

FaceBoundary face_boundary(const Part& part, const Face& face, const std::vector<ArcChain>& chains,
                           bool with_uv) {
  FaceBoundary boundary;
  for (const Loop& trims : face.loops) {
    FaceLoop loop;
    std::vector<Vec2> polygon;
    std::vector<std::array<Vec3, 3>> outward;
    bool broken_by_seam = false;
    for (const Trim& trim : trims) {
      append_trim(part, face, trim, chains, with_uv, loop, polygon, outward);
      broken_by_seam |= is_inner_seam(face, trim) || trim.degenerate;
    }
    const bool single = trims.size() == 1 && !trims[0].degenerate;
    if (single) loop.whole_ellipse = whole_ellipse(part.edges[trims[0].edge], loop.ellipse);
    if (!broken_by_seam) {
      reach_over_gaps(loop, outward);
      close_gaps(loop);
    }
    if (!loop.arcs.empty()) boundary.loops.push_back(std::move(loop));
    if (with_uv) {
      for (Vec2 p : polygon) boundary.uv_box.add(p);
      boundary.uv_loops.push_back(std::move(polygon));
    }
  }
  if (boundary.uv_box.empty()) boundary.uv_box = face.uv_box;
  return boundary;
}

bool is_inner_seam(const Face& face, const Trim& trim) {
  if (!trim.seam) return false;
  int uses = 0;
  for (const Loop& loop : face.loops)
    for (const Trim& other : loop) uses += other.edge == trim.edge;
  return uses > 1;
}

bool uv_inside(const FaceBoundary& boundary, Vec2 uv) {
  if (boundary.uv_loops.empty()) return boundary.uv_box.contains(uv);
  bool inside = false;
  for (const auto& polygon : boundary.uv_loops)
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const Vec2 a = polygon[j], b = polygon[i];
      if ((a.y > uv.y) == (b.y > uv.y)) continue;
      if ((uv.x < a.x + (b.x - a.x) * (uv.y - a.y) / (b.y - a.y))) inside = !inside;
    }
  return inside;
}

UvRectangle uv_rectangle(const Part& part, const Face& face, const FaceBoundary& boundary) {
  UvRectangle result;
  const Box2 box = boundary.uv_box;
  const Vec2 eps = box.size() * 1e-7;
  if (face.loops.empty()) {
    result.rectangle = true;
    return result;
  }
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      bool on[4] = {true, true, true, true};
      const int samples = std::holds_alternative<LineOf<Vec2>>(trim.pcurve.geometry) ? 2 : 9;
      for (int i = 0; i < samples; ++i) {
        const Vec2 p = point_at(trim.pcurve, edge.t0 + (edge.t1 - edge.t0) * i / (samples - 1));
        on[0] &= std::abs(p.x - box.lo.x) <= eps.x, on[1] &= std::abs(p.x - box.hi.x) <= eps.x;
        on[2] &= std::abs(p.y - box.lo.y) <= eps.y, on[3] &= std::abs(p.y - box.hi.y) <= eps.y;
      }
      const int side = on[0] ? 0 : on[1] ? 1 : on[2] ? 2 : on[3] ? 3 : -1;
      if (side < 0) return result;
      if (is_inner_seam(face, trim) || trim.degenerate) continue;
      result.side_edge[side] = true;
      result.side_drawn[side] |= !edge.smooth;
    }
  result.rectangle = true;
  return result;
}

}  // namespace dupin
