// Plane faces: the DP is the plane, its footprint the outer loop if that is a convex quadrilateral, else the
// smallest rectangle along one of its edges; everything else is boundary pieces.
#include <algorithm>
#include <cmath>

#include "chart_region.h"
#include "quadric_faces.h"

namespace dupin {
namespace {

/// Edges tried as the rectangle's direction.
constexpr std::size_t kMaxDirections = 8;
constexpr double kCollinear = 1e-9;

struct Corner {
  Vec2 p;
  bool feature;  ///< of the side that starts here
};

void add_hull(const FaceArc& arc, const QuadricDp& frame, Box2& box) {
  auto add = [&](const Vec3& p) {
    box.add({dot(p - frame.origin, frame.u), dot(p - frame.origin, frame.v)});
  };
  if (arc.arc.line) return add(arc.arc.p0), add(arc.arc.p2);
  const Vec3 mid = (arc.arc.p0 + arc.arc.p2) * 0.5, rise = (arc.arc.p1 - mid) * (arc.arc.w / (1 + arc.arc.w));
  add(arc.arc.p0), add(arc.arc.p2), add(arc.arc.p0 + rise), add(arc.arc.p2 + rise);
}

void add_ellipse(const WholeEllipse& e, const QuadricDp& frame, Box2& box) {
  const double rx = std::hypot(dot(e.x, frame.u), dot(e.y, frame.u)),
               ry = std::hypot(dot(e.x, frame.v), dot(e.y, frame.v));
  const Vec2 c{dot(e.center - frame.origin, frame.u), dot(e.center - frame.origin, frame.v)};
  box.add(c - Vec2{rx, ry}), box.add(c + Vec2{rx, ry});
}

Box2 loop_box(const FaceLoop& loop, const QuadricDp& frame) {
  Box2 box;
  if (loop.whole_ellipse)
    add_ellipse(loop.ellipse, frame, box);
  else
    for (const FaceArc& arc : loop.arcs) add_hull(arc, frame, box);
  return box;
}

/// Directions of the longest straight edges of a loop.
std::vector<Vec3> straight_directions(const FaceLoop& loop) {
  std::vector<std::pair<double, Vec3>> edges;
  for (const FaceArc& arc : loop.arcs) {
    const Vec3 d = arc.arc.p2 - arc.arc.p0;
    const double l = length(d);
    if (arc.arc.line && l > 0) edges.push_back({l, d / l});
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec3> directions;
  for (const auto& [l, d] : edges) {
    const bool known = std::any_of(directions.begin(), directions.end(), [&](const Vec3& k) {
      const double c = std::abs(dot(k, d));
      return c > 1 - 1e-12 || c < 1e-6;  // a perpendicular direction gives the same rectangle
    });
    if (!known) directions.push_back(d);
    if (directions.size() == kMaxDirections) break;
  }
  return directions;
}

/// The corners of a loop of straight pieces, those where it goes on straight (and drawn alike) left out.
std::vector<Corner> polygon_corners(const FaceLoop& loop, const ChartProjector& chart) {
  std::vector<Corner> corners;
  for (const FaceArc& arc : loop.arcs) {
    if (!arc.arc.line) return {};
    corners.push_back({chart.to_chart(arc.arc.p0), arc.feature});
    if (corners.size() > 64) return {};
  }
  for (std::size_t i = 0; i < corners.size() && corners.size() > 3;) {
    const std::size_t n = corners.size();
    const Corner &before = corners[(i + n - 1) % n], &after = corners[(i + 1) % n];
    const Vec2 a = corners[i].p - before.p, b = after.p - corners[i].p;
    const bool straight = std::abs(cross(a, b)) <= kCollinear * (dot(a, a) + dot(b, b)) && dot(a, b) >= 0;
    if (straight && before.feature == corners[i].feature)
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return corners;
}

/// A convex polygon of three or four corners as a footprint, counter-clockwise.
bool as_footprint(std::vector<Corner> corners, QuadricDp& dp) {
  if (corners.size() != 3 && corners.size() != 4) return false;
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += cross(corners[i].p, corners[(i + 1) % corners.size()].p);
  if (area < 0) {
    std::reverse(corners.begin(), corners.end());
    const bool first = corners.front().feature;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) corners[i].feature = corners[i + 1].feature;
    corners.back().feature = first;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[(i + 1) % corners.size()].p - corners[i].p;
    const Vec2 b = corners[(i + 2) % corners.size()].p - corners[(i + 1) % corners.size()].p;
    if (!(cross(a, b) > 0)) return false;
  }
  dp.feature_sides = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool repeated = i == 3 && corners.size() == 3;
    dp.footprint[i] = repeated ? corners[0].p : corners[i].p;
    if (!repeated && corners[i].feature) dp.feature_sides |= static_cast<std::uint8_t>(1u << i);
  }
  return true;
}

bool is_axis_rectangle(const QuadricDp& dp, const Box2& box) {
  const double eps = 1e-9 * length(box.size());
  const Vec2 c[4] = {box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}};
  for (int shift = 0; shift < 4; ++shift) {
    bool equal = true;
    for (int i = 0; i < 4; ++i) equal &= length(dp.footprint[(i + shift) % 4] - c[i]) <= eps;
    if (equal) return true;
  }
  return false;
}

/// Starts the corners' cycle at (lo, lo), as halving the footprint expects.
void rotate_to_lowest(QuadricDp& dp, const Box2& box) {
  int first = 0;
  for (int i = 1; i < 4; ++i)
    if (length(dp.footprint[i] - box.lo) < length(dp.footprint[first] - box.lo)) first = i;
  std::rotate(dp.footprint.begin(), dp.footprint.begin() + first, dp.footprint.end());
  const unsigned bits = dp.feature_sides & 15u;
  dp.feature_sides = static_cast<std::uint8_t>(((bits >> first) | (bits << (4 - first))) & 15u);
}

void set_rectangle(QuadricDp& dp, const Box2& box) {
  dp.footprint = {box.lo, Vec2{box.hi.x, box.lo.y}, box.hi, Vec2{box.lo.x, box.hi.y}};
  dp.feature_sides = 0;
}

/// The plane's frame, x along the edge that gives the smallest rectangle, the origin at that rectangle's
/// centre.
QuadricDp plane_frame(const FaceLoop& outer, const Vec3& normal, const Vec3& fallback_direction) {
  QuadricDp best;
  double least = 1e300;
  std::vector<Vec3> directions = straight_directions(outer);
  if (directions.empty()) directions.push_back(fallback_direction);
  for (const Vec3& d : directions) {
    QuadricDp dp;
    dp.u = normalized(d - normal * dot(d, normal));
    dp.v = cross(normal, dp.u);
    dp.origin = outer.arcs.empty() ? outer.ellipse.center : outer.arcs[0].arc.p0;
    const Box2 box = loop_box(outer, dp);
    const double area = box.size().x * box.size().y;
    if (area < least * (1 - 1e-9)) {
      least = area;
      best = dp;
      best.origin = dp.origin + dp.u * box.center().x + dp.v * box.center().y;
    }
  }
  return best;
}

}  // namespace

int make_plane_face(const QuadricFaceInput& in, PartDps& out) {
  const Frame3& frame = std::get<Plane>(in.surface.geometry).frame;
  const Vec3 surface_normal = cross(frame.x, frame.y);
  const Vec3 normal = in.outward_is_normal ? surface_normal : -surface_normal;
  const auto& loops = in.boundary.loops;
  if (loops.empty()) return 0;
  std::size_t outer = 0;
  double most = -1;
  QuadricDp any;
  any.u = frame.x, any.v = cross(normal, frame.x), any.origin = frame.origin;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Vec2 s = loop_box(loops[i], any).size();
    if (s.x * s.x + s.y * s.y > most) most = s.x * s.x + s.y * s.y, outer = i;
  }
  QuadricDp dp = plane_frame(loops[outer], normal, frame.x);
  // The rectangle lies in the plane itself, not at the height of a loop that is off it by its tolerance.
  dp.origin = dp.origin - surface_normal * dot(dp.origin - frame.origin, surface_normal);
  dp.planar = true, dp.exact = true;
  dp.face = in.face_index;
  dp.cell = in.uv_box;
  const Box2 box = loop_box(loops[outer], dp);
  const double size = length(box.size());
  dp.z_lo = -1e-6 * size, dp.z_hi = 1e-6 * size;

  ChartProjector corners_chart(dp);
  const bool quad = as_footprint(polygon_corners(loops[outer], corners_chart), dp);
  const bool rectangle = quad && is_axis_rectangle(dp, box);
  if (rectangle) rotate_to_lowest(dp, box);
  std::size_t others = 0;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (i != outer) others += loops[i].whole_ellipse ? 1 : loops[i].arcs.size();
  const bool outer_is_footprint = quad && (rectangle || others <= kMaxPieces);
  if (!outer_is_footprint) {
    // The pieces bound the face; the rectangle need only hold them, whatever their coordinates' rounding.
    const Vec2 margin{1e-5 * size, 1e-5 * size};
    set_rectangle(dp, {box.lo - margin, box.hi + margin});
  }
  ChartProjector chart(dp);
  ChartPieces pieces;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (i == outer && outer_is_footprint) {
      for (const FaceArc& arc : loops[i].arcs) dp.bound = std::max(dp.bound, arc.bound);
      continue;
    }
    if (loops[i].whole_ellipse)
      chart.add(loops[i].ellipse, pieces), dp.bound = std::max(dp.bound, loops[i].ellipse.bound);
    else
      for (const FaceArc& arc : loops[i].arcs)
        if (chart.add(arc, pieces)) dp.bound = std::max(dp.bound, arc.bound);
  }
  // Beyond the outer loop, where nothing is inside; without that loop's pieces everything there is.
  const Vec2 reference = box.lo - box.size() * 0.0137;
  return emit_exact_dp(dp, pieces, reference, outer_is_footprint, out);
}

}  // namespace dupin
