#include "boundary.h"

#include <algorithm>
#include <cmath>

namespace dupin {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
/// Polygon sides a flattened pcurve has for each arc of its edge.
constexpr int kUvSidesPerArc = 8;

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

/// One face's loop on its way.
struct OpenLoop {
  FaceLoop loop;
  std::vector<Vec2> polygon;
  Box2 around;                  ///< contains the pcurves, not only the polygon
  std::vector<ArcReach> reach;  ///< of loop.arcs, in the loop's direction
  std::vector<bool> goes_on;    ///< whether the next arc starts where this one ends
  bool broken = false;          ///< by a seam or a point
  bool starts_anew = false;     ///< such a break comes before the first arc
};

double largest(const ArcReach& reach) {
  return std::max({length(reach.by[0]), length(reach.by[1]), length(reach.by[2])});
}

void append_trim(const Part& part, const Face& face, const Trim& trim, const PartEdges& edges,
                 std::span<const ArcReach> reach, bool with_uv, OpenLoop& out) {
  const Edge& edge = part.edges[trim.edge];
  const auto& arcs = edges.chains()[trim.edge].arcs;
  const bool seam = is_inner_seam(face, trim);
  if (arcs.empty() || trim.degenerate || seam) {
    Box2 box;
    if (with_uv)
      for (std::size_t k = 0; k < std::max<std::size_t>(arcs.size(), 1); ++k) {
        const std::size_t i = trim.reversed && !arcs.empty() ? arcs.size() - 1 - k : k;
        const bool whole = arcs.empty() || trim.degenerate;
        flatten(trim, whole ? edge.t0 : arcs[i].t0, whole ? edge.t1 : arcs[i].t1, trim.reversed, out.polygon,
                box);
        if (whole) break;
      }
    if (with_uv) out.around.add(box.lo), out.around.add(box.hi);
    out.broken = true;
    if (out.goes_on.empty())
      out.starts_anew = true;
    else
      out.goes_on.back() = false;
    return;
  }
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const std::size_t i = trim.reversed ? arcs.size() - 1 - k : k;
    FaceArc face_arc{trim.reversed ? reversed(arcs[i]) : arcs[i], !edge.smooth, {}, 0, 0};
    if (with_uv) {
      flatten(trim, arcs[i].t0, arcs[i].t1, trim.reversed, out.polygon, face_arc.uv);
      out.around.add(face_arc.uv.lo), out.around.add(face_arc.uv.hi);
    }
    ArcReach r = reach.empty() ? ArcReach{} : reach[i];
    if (trim.reversed) std::swap(r.by[0], r.by[2]);
    face_arc.reach = largest(r);
    face_arc.bound = arcs[i].deviation + r.own;
    out.loop.arcs.push_back(face_arc);
    out.reach.push_back(r);
    out.goes_on.push_back(true);
  }
}

/// The direction in which an arc starts or stops.
Vec3 end_tangent(const ConicArc3& arc, bool last) {
  if (arc.line) return normalized(arc.p2 - arc.p0);
  return normalized(last ? arc.p2 - arc.p1 : arc.p1 - arc.p0);
}

/// Where two arcs meet that are moved outwards by `a` and `b` there, s and t being their directions: both are
/// drawn on (or cut short) along themselves, the first by `on`, the second by `back` from its start, to the
/// displacement `at`.
struct Mitre {
  Vec3 at;
  double on = 0, back = 0;
};
Mitre mitre(const Vec3& a, const Vec3& s, const Vec3& b, const Vec3& t) {
  constexpr double kLeastSine = 0.2, kMostTimes = 4;
  const double c = dot(s, t), s2 = 1 - c * c;
  if (!(s2 > kLeastSine * kLeastSine)) return {(a + b) * 0.5};
  // a + α s = b + β t in the least squares' sense.
  const Vec3 d = b - a;
  const double alpha = (dot(d, s) - c * dot(d, t)) / s2, beta = (c * dot(d, s) - dot(d, t)) / s2;
  const Vec3 meeting = (a + s * alpha + b + t * beta) * 0.5;
  const double most = kMostTimes * std::max(length(a), length(b));
  return length(meeting) <= most ? Mitre{meeting, alpha, beta} : Mitre{(a + b) * 0.5};
}

/// The arc from `from` after its start to `on` beyond its end, lengths that are small beside its own.
ConicArc3 drawn_on(const ConicArc3& arc, double from, double on) {
  if (arc.line || (from == 0 && on == 0)) return arc;
  const double first = 2 * arc.w * distance(arc.p0, arc.p1), last = 2 * arc.w * distance(arc.p1, arc.p2);
  if (!(std::abs(from) < 0.2 * first && std::abs(on) < 0.2 * last)) return arc;
  ConicArc3 out = sub_arc(arc, from / first, 1 + on / last);
  out.deviation = arc.deviation;
  return out;
}

/// Moves the arcs outwards by as much as the face reaches over its edges; those that follow one another stay
/// joined.
void reach_over_edges(OpenLoop& open) {
  auto& arcs = open.loop.arcs;
  const std::size_t n = arcs.size();
  if (std::none_of(arcs.begin(), arcs.end(), [](const FaceArc& a) { return a.reach > 0; })) return;
  std::vector<Vec3> joint(n);  // where arc i's end goes, if another starts there
  std::vector<double> from(n, 0), on(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    open.goes_on[i] = open.goes_on[i] && n > 1 && !(next == 0 && open.starts_anew);
    if (!open.goes_on[i]) continue;
    const Mitre m = mitre(open.reach[i].by[2], end_tangent(arcs[i].arc, true), open.reach[next].by[0],
                          end_tangent(arcs[next].arc, false));
    joint[i] = arcs[i].arc.p2 + m.at, on[i] = m.on, from[next] = m.back;
  }
  for (std::size_t i = 0; i < n; ++i) {
    displace(arcs[i].arc, open.reach[i].by);
    arcs[i].arc = drawn_on(arcs[i].arc, from[i], on[i]);
  }
  for (std::size_t i = 0; i < n; ++i)
    if (open.goes_on[i]) arcs[i].arc.p2 = arcs[(i + 1) % n].arc.p0 = joint[i];
}

/// A whole circle or ellipse keeps its form, a little larger or smaller.
void reach_over_edges(WholeEllipse& ellipse, const OpenLoop& open) {
  double most = 0, side = 0;
  for (std::size_t i = 0; i < open.reach.size(); ++i) {
    most = std::max(most, open.loop.arcs[i].reach);
    side += dot(open.reach[i].by[1], open.loop.arcs[i].arc.p1 - ellipse.center);
    ellipse.bound = std::max(ellipse.bound, open.loop.arcs[i].bound);
  }
  const double by = side < 0 ? -most : most;
  ellipse.x *= 1 + by / length(ellipse.x), ellipse.y *= 1 + by / length(ellipse.y);
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

FaceBoundary face_boundary(const Part& part, std::uint32_t face_index, const PartEdges& edges, bool with_uv) {
  const Face& face = part.faces[face_index];
  FaceBoundary boundary;
  std::size_t used = 0;
  for (const Loop& trims : face.loops) {
    OpenLoop open;
    for (const Trim& trim : trims)
      append_trim(part, face, trim, edges, edges.reach(face_index, used++), with_uv, open);
    FaceLoop& loop = open.loop;
    if (trims.size() == 1 && !open.broken && edges.moved(trims[0].edge) == 0)
      loop.whole_ellipse = whole_ellipse(part.edges[trims[0].edge], loop.ellipse);
    if (loop.whole_ellipse) reach_over_edges(loop.ellipse, open);
    reach_over_edges(open);
    if (!open.broken) close_gaps(loop);
    for (const FaceArc& arc : loop.arcs) boundary.reach = std::max(boundary.reach, arc.reach);
    if (!loop.arcs.empty()) boundary.loops.push_back(std::move(loop));
    if (with_uv) {
      // The polygon cuts corners; both boxes contain the curves.
      boundary.uv_box.add(
          Vec2{std::max(open.around.lo.x, face.uv_box.lo.x), std::max(open.around.lo.y, face.uv_box.lo.y)});
      boundary.uv_box.add(
          Vec2{std::min(open.around.hi.x, face.uv_box.hi.x), std::min(open.around.hi.y, face.uv_box.hi.y)});
      for (Vec2 p : open.polygon) boundary.uv_box.add(p);
      boundary.uv_loops.push_back(std::move(open.polygon));
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

UvRectangle uv_rectangle(const Part& part, std::uint32_t face_index, const PartEdges& edges,
                         const FaceBoundary& boundary) {
  const Face& face = part.faces[face_index];
  UvRectangle result;
  std::size_t used = 0;
  const Box2 box = boundary.uv_box;
  const Vec2 eps = box.size() * 1e-7;
  if (face.loops.empty()) {
    result.rectangle = true;
    return result;
  }
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      const auto reach = edges.reach(face_index, used++);
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
      for (const ArcReach& r : reach) {
        result.side_reach[side] = std::max(result.side_reach[side], largest(r) + edges.moved(trim.edge));
        result.bound = std::max(result.bound, r.own);
      }
    }
  result.rectangle = true;
  return result;
}

}  // namespace dupin
