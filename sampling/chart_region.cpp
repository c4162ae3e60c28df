#include "chart_region.h"

#include <algorithm>
#include <cmath>

#include "piece_tests.h"

namespace dupin {
namespace {

/// The sheet ends where ∂F/∂z falls below this: 3 degrees short of vertical on a cylinder.
constexpr double kSheetMargin = 0.05;
/// Halvings of an exact DP's footprint.
constexpr int kMaxSplits = 16;

Box2 box_of(std::span<const Vec2> points) {
  Box2 box;
  for (Vec2 p : points) box.add(p);
  return box;
}

std::array<Vec2, 3> hull_of(const ArcPiece& a) {
  return {a.p0, a.p1, a.p2};
}
std::array<Vec2, 2> hull_of(const LinePiece& l) {
  return {l.p0, l.p1};
}
std::array<Vec2, 4> hull_of(const EllipsePiece& e) {
  // |m d| <= 1 implies |d| <= 1 / (least eigenvalue of m).
  const double mean = (e.mxx + e.myy) / 2, least = mean - std::hypot((e.mxx - e.myy) / 2, e.mxy),
               r = 1 / least;
  return {e.center + Vec2{-r, -r}, e.center + Vec2{r, -r}, e.center + Vec2{r, r}, e.center + Vec2{-r, r}};
}

/// Bulges and ellipses that hold p: what `reference_inside` has folded in.
bool area_parity(const ChartPieces& pieces, Vec2 p) {
  bool odd = false;
  for (const ArcPiece& a : pieces.arcs) odd ^= in_bulge(a, p);
  for (const EllipsePiece& e : pieces.ellipses) odd ^= in_ellipse(e, p);
  return odd;
}

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double dd = dot(d, d), s = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
  return length(p - a - d * s);
}

/// Of a few points of the rectangle, the one farthest from every piece.
Vec2 choose_reference(const ChartPieces& pieces, const Box2& box) {
  Vec2 best = box.center();
  double most = -1;
  for (double fy : {0.53, 0.21, 0.83, 0.37, 0.67})
    for (double fx : {0.47, 0.79, 0.17, 0.63, 0.31}) {
      const Vec2 p{box.lo.x + box.size().x * fx, box.lo.y + box.size().y * fy};
      const double c = clearance(pieces, p);
      if (c > most) most = c, best = p;
    }
  return best;
}

ChartPieces pieces_meeting(const ChartPieces& pieces, const std::array<Vec2, 4>& quad) {
  ChartPieces kept;
  for (const LinePiece& l : pieces.lines)
    if (may_meet(quad, hull_of(l))) kept.lines.push_back(l);
  for (const ArcPiece& a : pieces.arcs)
    if (may_meet(quad, hull_of(a))) kept.arcs.push_back(a);
  for (const EllipsePiece& e : pieces.ellipses)
    if (may_meet(quad, hull_of(e))) kept.ellipses.push_back(e);
  return kept;
}

}  // namespace

bool may_meet(const std::array<Vec2, 4>& quad, std::span<const Vec2> hull) {
  const Box2 a = box_of(quad), b = box_of(hull);
  if (!overlap(a, b)) return false;
  for (int i = 0; i < 4; ++i) {
    const Vec2 from = quad[i], side = quad[(i + 1) % 4] - from;
    if (side == Vec2{}) continue;
    const bool all_outside =
        std::all_of(hull.begin(), hull.end(), [&](Vec2 p) { return cross(side, p - from) < 0; });
    if (all_outside) return false;
  }
  if (hull.size() == 2) {
    const Vec2 side = hull[1] - hull[0];
    int left = 0;
    for (Vec2 q : quad) left += cross(side, q - hull[0]) > 0;
    if (left == 0 || left == 4) return false;
  }
  return true;
}

ChartProjector::ChartProjector(const QuadricDp& dp) : dp_(dp), n_(dp.n()) {
  // ∂F/∂z = 1 − a·x − b·y − c·z as an affine function of a point of the part.
  sheet_normal_ = -(dp.u * dp.a + dp.v * dp.b + n_ * dp.c);
  sheet_offset_ = 1 - dot(sheet_normal_, dp.origin) - kSheetMargin;
  single_sheet_ = dp.a == 0 && dp.b == 0 && dp.c == 0;
  footprint_box_ = box_of(dp.footprint);
}

Vec3 ChartProjector::to_local(const Vec3& p) const {
  const Vec3 d = p - dp_.origin;
  return {dot(d, dp_.u), dot(d, dp_.v), dot(d, n_)};
}

Vec2 ChartProjector::to_chart(const Vec3& p) const {
  const Vec3 d = p - dp_.origin;
  return {dot(d, dp_.u), dot(d, dp_.v)};
}

void ChartProjector::add_on_sheet(const ConicArc3& arc, bool feature, ChartPieces& out) const {
  const Vec2 p0 = to_chart(arc.p0), p2 = to_chart(arc.p2);
  if (arc.line) {
    const LinePiece piece{p0, p2, feature};
    if (may_meet(dp_.footprint, hull_of(piece))) out.lines.push_back(piece);
    return;
  }
  const Vec2 p1 = to_chart(arc.p1), chord = p2 - p0;
  const ArcPiece piece{p0, p1, p2, arc.w, feature};
  if (!may_meet(dp_.footprint, hull_of(piece))) return;
  // An arc seen edge-on, or all but: its chord.
  if (std::abs(cross(chord, p1 - p0)) <= 1e-9 * (dot(chord, chord) + dot(p1 - p0, p1 - p0)))
    out.lines.push_back({p0, p2, feature});
  else
    out.arcs.push_back(piece);
}

bool ChartProjector::add(const FaceArc& arc, ChartPieces& out) {
  const std::size_t before = out.count();
  if (single_sheet_) {
    add_on_sheet(arc.arc, arc.feature, out);
  } else {
    clipped_.clear();
    clip_to_half_space(arc.arc, sheet_normal_, sheet_offset_, clipped_);
    for (const ConicArc3& part : clipped_) add_on_sheet(part, arc.feature, out);
  }
  return out.count() > before;
}

void ChartProjector::add(const WholeEllipse& ellipse, ChartPieces& out) const {
  const Vec2 x{dot(ellipse.x, dp_.u), dot(ellipse.x, dp_.v)}, y{dot(ellipse.y, dp_.u), dot(ellipse.y, dp_.v)};
  // In the face's own plane the axes stay perpendicular: m = x̂x̂ᵀ/|x| + ŷŷᵀ/|y|.
  const double a = dot(x, x), b = dot(y, y), ia = 1 / (a * std::sqrt(a)), ib = 1 / (b * std::sqrt(b));
  out.ellipses.push_back({to_chart(ellipse.center), x.x * x.x * ia + y.x * y.x * ib,
                          x.x * x.y * ia + y.x * y.y * ib, x.y * x.y * ia + y.y * y.y * ib, ellipse.feature});
}

double clearance(const ChartPieces& pieces, Vec2 p) {
  double least = 1e300;
  for (const LinePiece& l : pieces.lines) least = std::min(least, distance_to_segment(p, l.p0, l.p1));
  for (const ArcPiece& a : pieces.arcs) {
    const Vec2 mid = (a.p0 + a.p2) * 0.5, shoulder = mid + (a.p1 - mid) * (a.w / (1 + a.w));
    least = std::min({least, distance_to_segment(p, a.p0, shoulder), distance_to_segment(p, shoulder, a.p2)});
  }
  for (const EllipsePiece& e : pieces.ellipses) {
    const Vec2 d = p - e.center;
    const double x = e.mxx * d.x + e.mxy * d.y, y = e.mxy * d.x + e.myy * d.y;
    least = std::min(least, std::abs(std::hypot(x, y) - 1) / std::max(e.mxx, e.myy));
  }
  return least;
}

bool state_at(const ChartPieces& pieces, Vec2 reference, bool reference_state, Vec2 p) {
  bool inside = reference_state ^ area_parity(pieces, reference) ^ area_parity(pieces, p);
  for (const LinePiece& l : pieces.lines) inside ^= crosses(reference, p, l.p0, l.p1);
  for (const ArcPiece& a : pieces.arcs) inside ^= crosses(reference, p, a.p0, a.p2);
  return inside;
}

void emit_dp(const QuadricDp& dp, const ChartPieces& pieces, Vec2 reference, bool reference_state,
             PartDps& out) {
  QuadricDp d = dp;
  d.first_line = static_cast<std::uint32_t>(out.lines.size());
  d.first_arc = static_cast<std::uint32_t>(out.arcs.size());
  d.first_ellipse = static_cast<std::uint32_t>(out.ellipses.size());
  d.lines = static_cast<std::uint16_t>(pieces.lines.size());
  d.arcs = static_cast<std::uint16_t>(pieces.arcs.size());
  d.ellipses = static_cast<std::uint16_t>(pieces.ellipses.size());
  d.reference = reference;
  d.reference_inside = reference_state ^ area_parity(pieces, reference);
  out.lines.insert(out.lines.end(), pieces.lines.begin(), pieces.lines.end());
  out.arcs.insert(out.arcs.end(), pieces.arcs.begin(), pieces.arcs.end());
  out.ellipses.insert(out.ellipses.end(), pieces.ellipses.begin(), pieces.ellipses.end());
  out.dps.push_back(d);
}

namespace {

struct ExactEmitter {
  const QuadricDp& dp;
  PartDps& out;
  int emitted = 0;

  void emit(const ChartPieces& pieces, const Box2& box, std::uint8_t sides, Vec2 reference, bool state,
            int depth) {
    if (pieces.empty() && !state) return;
    if (pieces.count() <= kMaxPieces || depth >= kMaxSplits) {
      QuadricDp d = dp;
      if (depth > 0) {
        d.footprint = {Vec2{box.lo.x, box.lo.y}, Vec2{box.hi.x, box.lo.y}, Vec2{box.hi.x, box.hi.y},
                       Vec2{box.lo.x, box.hi.y}};
        d.feature_sides = static_cast<std::uint8_t>((dp.feature_sides & 0xF0) | sides);
      }
      emit_dp(d, pieces, reference, state, out);
      ++emitted;
      return;
    }
    const bool along_x = box.size().x >= box.size().y;
    const double cut = along_x ? split_position(pieces, box, 0) : split_position(pieces, box, 1);
    for (int half = 0; half < 2; ++half) {
      Box2 part = box;
      std::uint8_t part_sides = sides;
      // Sides of the footprint: 0 is y = lo, 1 is x = hi, 2 is y = hi, 3 is x = lo.
      if (along_x) {
        (half ? part.lo.x : part.hi.x) = cut;
        part_sides &= static_cast<std::uint8_t>(~(half ? 8 : 2));
      } else {
        (half ? part.lo.y : part.hi.y) = cut;
        part_sides &= static_cast<std::uint8_t>(~(half ? 1 : 4));
      }
      const std::array<Vec2, 4> quad{part.lo, {part.hi.x, part.lo.y}, part.hi, {part.lo.x, part.hi.y}};
      const ChartPieces kept = pieces_meeting(pieces, quad);
      const Vec2 r = choose_reference(kept, part);
      emit(kept, part, part_sides, r, state_at(pieces, reference, state, r), depth + 1);
    }
  }

  /// The median of the pieces' centres, kept away from the ends, so that the halves have about as many.
  static double split_position(const ChartPieces& pieces, const Box2& box, int axis) {
    std::vector<double> at;
    for (const LinePiece& l : pieces.lines) at.push_back((l.p0[axis] + l.p1[axis]) / 2);
    for (const ArcPiece& a : pieces.arcs) at.push_back((a.p0[axis] + a.p2[axis]) / 2);
    for (const EllipsePiece& e : pieces.ellipses) at.push_back(e.center[axis]);
    std::nth_element(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(at.size() / 2), at.end());
    const double lo = box.lo[axis], size = box.size()[axis];
    return std::clamp(at[at.size() / 2], lo + 0.2 * size, lo + 0.8 * size);
  }
};

}  // namespace

int emit_exact_dp(const QuadricDp& dp, const ChartPieces& pieces, Vec2 reference, bool reference_state,
                  PartDps& out) {
  ExactEmitter emitter{dp, out};
  emitter.emit(pieces, box_of(dp.footprint), dp.feature_sides, reference, reference_state, 0);
  return emitter.emitted;
}

}  // namespace dupin
