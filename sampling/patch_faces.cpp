#include "patch_faces.h"

#include <algorithm>
#include <cmath>

#include "../core/parallel.h"
#include "bezier_cell.h"
#include "chart_region.h"
#include "fitted_patches.h"

namespace dupin {
namespace {

/// Halvings of one Bézier patch; a cell that is still too wrong then is reported by its bounds.
constexpr int kMaxDepth = 36;

/// What cells beside an edge may be off, as a part of the tolerance.
constexpr double kBesideEdges = 0.9;

/// A cell smaller than this part of the tolerance is not worth a fit: it is drawn flat.
constexpr double kSpeck = 0.5;
/// Patches that one thread divides at a time.
constexpr std::size_t kPatchesPerTask = 8;

/// A cell is grown by at most this part of itself to make room for its curved sides' chords.
constexpr double kMostMargin = 0.35;

struct Cell {
  BezierPatch patch;
  Box2 own{{0, 0}, {1, 1}};  ///< in the root patch's parameters
  std::vector<const FaceArc*> arcs;
  bool known = false, inside = false;  ///< no trim in it: wholly in or out
  int depth = 0;
};

Box2 shifted(const Box2& box, double du, double dv) {
  return {box.lo + Vec2{du, dv}, box.hi + Vec2{du, dv}};
}

class PatchFace {
 public:
  PatchFace(const PatchFaceInput& in, PartDps& out)
      : in_(in),
        out_(out),
        surface_(in.part.surfaces[in.face.surface]),
        period_u_(period_u(surface_)),
        period_v_(period_v(surface_)) {
    for (const Loop& loop : in.face.loops)
      for (const Trim& trim : loop)
        if (is_inner_seam(in.face, trim)) note_seam(trim);
  }

  void divide_patch(const FittedPatch& fitted) {
    fitted_position_ = fitted.position_error, fitted_normal_ = fitted.normal_error;
    root_ = fitted.patch;
    Cell cell;
    cell.patch = fitted.patch;
    for (const FaceLoop& loop : in_.boundary.loops)
      for (const FaceArc& arc : loop.arcs) cell.arcs.push_back(&arc);
    divide(cell);
  }

  int made() const { return made_; }

 private:
  void note_seam(const Trim& trim) {
    const Edge& edge = in_.part.edges[trim.edge];
    const Vec2 p = point_at(trim.pcurve, (edge.t0 + edge.t1) / 2);
    const Box2& box = in_.boundary.uv_box;
    const Vec2 eps = box.size() * 1e-6;
    seam_[0] |= std::abs(p.y - box.lo.y) <= eps.y, seam_[1] |= std::abs(p.x - box.hi.x) <= eps.x;
    seam_[2] |= std::abs(p.y - box.hi.y) <= eps.y, seam_[3] |= std::abs(p.x - box.lo.x) <= eps.x;
  }

  Box2 uv_of(const Box2& own) const {
    return {{patch_to_surface_u(root_, own.lo.x), patch_to_surface_v(root_, own.lo.y)},
            {patch_to_surface_u(root_, own.hi.x), patch_to_surface_v(root_, own.hi.y)}};
  }

  /// Whether the trim may come into the cell grown by a part of its size, seen across the seam too.
  bool is_near(const FaceArc& arc, const Box2& uv, double part) const {
    const Vec2 margin = uv.size() * part;
    const Box2 near{uv.lo - margin, uv.hi + margin};
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        if ((i != 0 && period_u_ == 0) || (j != 0 && period_v_ == 0)) continue;
        if (overlap(near, shifted(arc.uv, i * period_u_, j * period_v_))) return true;
      }
    return false;
  }

  /// Keeps the trims that a footprint of the cell may reach; those in the cell itself make it a cut one.
  void filter_arcs(Cell& cell, const Box2& uv) const {
    std::erase_if(cell.arcs, [&](const FaceArc* arc) { return !is_near(*arc, uv, 1.5 * kMostMargin); });
    if (cell.known) return;
    cell.known = std::none_of(cell.arcs.begin(), cell.arcs.end(),
                              [&](const FaceArc* arc) { return is_near(*arc, uv, 1e-3); });
    if (cell.known) cell.inside = uv_inside(in_.boundary, uv.center());
  }

  void divide(Cell& cell) {
    const Box2 uv = uv_of(cell.own);
    filter_arcs(cell, uv);
    if (cell.known && !cell.inside) return;
    const Box3 box = poles_box(cell.patch);
    const double allowed = in_.tolerance.at(box);
    if (std::isinf(allowed)) return;
    // Beside what it reaches over edges, a cell's error comes at a right angle.
    const double tolerance = allowed * (!cell.known ? kTrimTolerance : cell.arcs.empty() ? 1 : kBesideEdges);
    allowed_ = allowed;
    const bool speck =
        box.diagonal() <= allowed * (cell.arcs.empty() ? 1 : kBesideEdges) || cell.depth >= kMaxDepth;
    if (box.diagonal() <= kSpeck * allowed) return emit_speck(cell, uv, box, {});
    CellFit fit =
        fitter_.fit(cell.patch, tolerance - fitted_position_, in_.normal_tolerance - fitted_normal_);
    if (fit.valid && emit(cell, uv, fit)) return;
    if (fit.valid && widen_margins(fit)) {
      CellFit wider = fitter_.fit(cell.patch, tolerance - fitted_position_,
                                  in_.normal_tolerance - fitted_normal_, fit.margins);
      if (wider.valid && emit(cell, uv, wider)) return;
    }
    if (speck) return emit_speck(cell, uv, box, fit);
    split(cell, fit.split_u);
  }

  void split(Cell& cell, bool along_u) {
    Cell first, second;
    split_patch(cell.patch, along_u, first.patch, second.patch);
    first.own = second.own = cell.own;
    (along_u ? first.own.hi.x : first.own.hi.y) = along_u ? cell.own.center().x : cell.own.center().y;
    (along_u ? second.own.lo.x : second.own.lo.y) = along_u ? cell.own.center().x : cell.own.center().y;
    for (Cell* half : {&first, &second}) {
      half->arcs = cell.arcs;
      half->known = cell.known, half->inside = cell.inside;
      half->depth = cell.depth + 1;
    }
    cell.patch.poles.clear();
    divide(first);
    divide(second);
  }

  bool emit(const Cell& cell, const Box2& uv, CellFit& fit) {
    QuadricDp& dp = fit.dp;
    dp.face = in_.face_index;
    dp.cell = uv;
    dp.bound = fit.bound + fitted_position_, dp.normal_bound = fit.normal_bound + fitted_normal_;
    dp.sampled_bound = fitted_position_ > 0 && !std::holds_alternative<BsplineSurface>(surface_.geometry);
    dp.flipped = in_.face.reversed;
    if (make_footprint(uv, fit)) return emit_region(cell, uv, dp);
    return cell.arcs.empty() && emit_bordered(cell, fit);
  }

  /// Whether the cell's side lies on the face's own border, where trims end it: there it need not match a
  /// neighbour.
  bool on_border(int side, const Box2& uv) const {
    const Box2& box = in_.boundary.uv_box;
    if (seam_[side] || in_.boundary.loops.empty()) return false;
    const Vec2 eps = box.size() * 1e-9;
    switch (side) {
      case 0:
        return uv.lo.y <= box.lo.y + eps.y;
      case 1:
        return uv.hi.x >= box.hi.x - eps.x;
      case 2:
        return uv.hi.y >= box.hi.y - eps.y;
      default:
        return uv.lo.x <= box.lo.x + eps.x;
    }
  }

  /// Where a curved side asked for more room than the certificate had: as much as it needs, if that is not
  /// too much.
  static bool widen_margins(CellFit& fit) {
    bool wider = false;
    for (int k = 0; k < 4; ++k) {
      const double needed = 1.1 * fit.margin_needed[k];
      if (needed > kMostMargin) return false;
      if (needed <= fit.margins.side[k]) continue;
      fit.margins.side[k] = needed;
      wider = true;
    }
    return wider;
  }

  struct SideLine {
    Vec2 point, out;  ///< out: unit, outwards
  };

  /// The convex quadrilateral of the four chords, each moved outwards until its side of the cell, and a
  /// little overlap with the neighbour, lie within; not farther than the certificate reaches.
  bool make_footprint(const Box2& uv, CellFit& fit) const {
    const Vec2 c[4] = {fit.border[0].front(), fit.border[1].front(), fit.border[2].back(),
                       fit.border[3].back()};
    const double size = std::max(length(c[2] - c[0]), length(c[3] - c[1]));
    SideLine lines[4];
    bool reached = true;
    for (int k = 0; k < 4; ++k) {
      const Vec2 a = c[k], d = c[(k + 1) % 4] - a;
      const bool point = length(d) <= 1e-9 * size;
      Vec2 out = point ? a - (c[(k + 2) % 4] + c[(k + 3) % 4]) * 0.5 : Vec2{d.y, -d.x};
      if (!(length(out) > 0)) return false;
      out = out / length(out);
      double bulge = 0, reach = 1e300;
      for (Vec2 p : fit.border[k]) bulge = std::max(bulge, dot(p - a, out));
      for (Vec2 p : fit.grown_border[k]) reach = std::min(reach, dot(p - a, out));
      const double wanted = 4 * fit.bound + 1e-4 * size;
      double overlap_width = wanted;
      fit.margin_needed[k] = 0;
      if (point)
        overlap_width = 0;
      else if (on_border(k, uv)) {
        overlap_width += 1.5 * in_.boundary.reach;
      } else {
        double own = 0;
        for (Vec2 p : fit.border[k]) own = std::min(own, dot(p - a, out));
        fit.margin_needed[k] = fit.margins.side[k] * (bulge + wanted - own) /
                               std::max(reach - own, 1e-3 * size * fit.margins.side[k]);
        if (reach - bulge < fit.bound + 1e-5 * size) reached = false;
        overlap_width = std::min(wanted, reach - bulge);
      }
      lines[k] = {a + out * (bulge + overlap_width), out};
    }
    if (!reached) return false;
    for (int k = 0; k < 4; ++k)
      if (!meet(lines[(k + 3) % 4], lines[k], fit.dp.footprint[k])) return false;
    return is_convex(fit.dp.footprint, size);
  }

  static bool meet(const SideLine& a, const SideLine& b, Vec2& p) {
    const double det = cross(a.out, b.out);
    if (!(det > 0.02)) return false;
    const double da = dot(a.out, a.point), db = dot(b.out, b.point);
    p = {(da * b.out.y - db * a.out.y) / det, (a.out.x * db - b.out.x * da) / det};
    return true;
  }

  static bool is_convex(const std::array<Vec2, 4>& q, double size) {
    for (int k = 0; k < 4; ++k)
      if (!(cross(q[(k + 1) % 4] - q[k], q[(k + 2) % 4] - q[(k + 1) % 4]) >= -1e-12 * size * size))
        return false;
    return true;
  }

  bool emit_region(const Cell& cell, const Box2& uv, QuadricDp dp) {
    ChartPieces pieces;
    ChartProjector chart(dp);
    double off = 0;
    for (const FaceArc* arc : cell.arcs)
      if (chart.add(*arc, pieces)) off = std::max(off, arc->bound);
    // Where the face ends, by as much as its edge is off, points may lie beyond the surface itself.
    dp.bound = std::hypot(dp.bound, off);
    if (cell.known && pieces.empty()) return count(dp, {}, {}, cell.inside);
    if (cell.known) return count(dp, pieces, chart.to_chart(point_at(cell.patch, 0.5, 0.5)), cell.inside);
    if (pieces.count() > kMaxPieces && cell.depth < kMaxDepth / 2) return false;
    Vec2 best{}, best_uv = uv.center();
    double most = -1;
    const int tries = pieces.empty() ? 1 : 3;
    for (int i = 0; i < tries; ++i)
      for (int j = 0; j < tries; ++j) {
        const double s = tries == 1 ? 0.5 : 0.11 + 0.383 * i, t = tries == 1 ? 0.5 : 0.13 + 0.377 * j;
        const Vec2 p = chart.to_chart(point_at(cell.patch, s, t));
        const double c = clearance(pieces, p);
        if (c <= most) continue;
        most = c, best = p;
        best_uv = {patch_to_surface_u(root_, cell.own.lo.x + cell.own.size().x * s),
                   patch_to_surface_v(root_, cell.own.lo.y + cell.own.size().y * t)};
      }
    return count(dp, pieces, best, uv_inside(in_.boundary, best_uv));
  }

  bool count(const QuadricDp& dp, const ChartPieces& pieces, Vec2 reference, bool state) {
    if (pieces.empty() && !state) return true;
    emit_dp(dp, pieces, reference, state, out_);
    out_.bound_px = std::max(out_.bound_px, dp.bound / allowed_ * in_.tolerance.tolerance_px());
    ++made_;
    return true;
  }

  /// A cell whose sides are too curved for straight ones: its border, half-way out to where the certificate
  /// reaches, as pieces.
  bool emit_bordered(const Cell& cell, CellFit& fit) {
    constexpr double m = kCellMargin / 2;
    const CollapsedSides collapsed = collapsed_sides(cell.patch);
    const double s0 = collapsed.u0 ? 0 : -m, s1 = collapsed.u1 ? 1 : 1 + m, t0 = collapsed.v0 ? 0 : -m,
                 t1 = collapsed.v1 ? 1 : 1 + m;
    ChartProjector chart(fit.dp);
    auto at = [&](double s, double t) { return chart.to_chart(point_at(cell.patch, s, t)); };
    ChartPieces pieces;
    Box2 box;
    for (int k = 0; k < 4; ++k) {
      auto on_side = [&](double f) {
        switch (k) {
          case 0:
            return at(s0 + (s1 - s0) * f, t0);
          case 1:
            return at(s1, t0 + (t1 - t0) * f);
          case 2:
            return at(s1 + (s0 - s1) * f, t1);
          default:
            return at(s0, t1 + (t0 - t1) * f);
        }
      };
      if ((k == 0 && collapsed.v0) || (k == 1 && collapsed.u1) || (k == 2 && collapsed.v1) ||
          (k == 3 && collapsed.u0))
        continue;
      if (!add_side(on_side, inner_distance(cell, k, chart), pieces, box)) return false;
    }
    const Vec2 margin = box.size() * 1e-4;
    const Box2 b{box.lo - margin, box.hi + margin};
    fit.dp.footprint = {b.lo, Vec2{b.hi.x, b.lo.y}, b.hi, Vec2{b.lo.x, b.hi.y}};
    return count(fit.dp, pieces, {0, 0}, true);
  }

  /// How far the widened side is from the cell's own, at its middle: what a piece may deviate by a part of.
  static double inner_distance(const Cell& cell, int side, const ChartProjector& chart) {
    constexpr double m = kCellMargin / 2;
    const Vec2 own[4] = {{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}},
               wide[4] = {{0.5, -m}, {1 + m, 0.5}, {0.5, 1 + m}, {-m, 0.5}};
    return length(chart.to_chart(point_at(cell.patch, own[side].x, own[side].y)) -
                  chart.to_chart(point_at(cell.patch, wide[side].x, wide[side].y)));
  }

  template <class OnSide>
  static bool add_side(const OnSide& on_side, double room, ChartPieces& pieces, Box2& box) {
    const Vec2 a = on_side(0), q1 = on_side(0.25), mid = on_side(0.5), q3 = on_side(0.75), b = on_side(1);
    const Vec2 p1 = mid * 2 - (a + b) * 0.5;
    auto quadratic = [&](double f) { return a * ((1 - f) * (1 - f)) + p1 * (2 * f * (1 - f)) + b * (f * f); };
    if (std::max(length(quadratic(0.25) - q1), length(quadratic(0.75) - q3)) > 0.3 * room) return false;
    for (Vec2 p : {a, p1, b}) box.add(p);
    const Vec2 chord = b - a;
    if (std::abs(cross(chord, p1 - a)) <= 1e-6 * dot(chord, chord))
      pieces.lines.push_back({a, b, false});
    else
      pieces.arcs.push_back({a, p1, b, 1, false});
    return true;
  }

  /// Smaller than the tolerance, and still no quadric could be proved right (a singular corner): a flat piece
  /// will do.
  void emit_speck(const Cell& cell, const Box2& uv, const Box3& box, const CellFit& fit) {
    QuadricDp dp;
    const double size = box.diagonal();
    if (!(size > 0)) return;
    dp.origin = point_at(cell.patch, 0.5, 0.5);
    Vec3 n = fit.dp.n();
    const Curvature k = principal_curvature(surface_, uv.center().x, uv.center().y, uv.center());
    if (is_finite(k.n) && length(k.n) > 0.5) n = k.n;
    dp.u = any_perpendicular(n), dp.v = cross(n, dp.u);
    dp.face = in_.face_index, dp.cell = uv, dp.flipped = in_.face.reversed;
    Box2 flat;
    for (const Vec4& pole : cell.patch.poles) {
      const Vec3 d = Vec3{pole.x, pole.y, pole.z} / pole.w - dp.origin;
      flat.add({dot(d, dp.u), dot(d, dp.v)});
    }
    const Vec2 margin{1e-3 * size, 1e-3 * size};
    dp.footprint = {flat.lo - margin, Vec2{flat.hi.x + margin.x, flat.lo.y - margin.y}, flat.hi + margin,
                    Vec2{flat.lo.x - margin.x, flat.hi.y + margin.y}};
    dp.z_lo = -1e-3 * size, dp.z_hi = 1e-3 * size;
    dp.bound = size, dp.speck = true;
    emit_region(cell, uv, dp);
  }

  const PatchFaceInput& in_;
  PartDps& out_;
  const Surface& surface_;
  const double period_u_, period_v_;
  bool seam_[4] = {false, false, false, false};
  BezierPatch root_;
  CellFitter fitter_;
  double fitted_position_ = 0, fitted_normal_ = 0;  ///< what an interpolated patch is off already
  double allowed_ = 0;                              ///< the tolerance where the present cell is
  int made_ = 0;
};

/// The surface in Bézier form: exactly, or interpolated where it is not rational.
std::vector<FittedPatch> patches_of(const PatchFaceInput& in, PatchFaceResult& result) {
  const Surface& surface = in.part.surfaces[in.face.surface];
  std::vector<FittedPatch> patches;
  // A spline that stands for the limit at an extraordinary vertex of a cage is itself off it.
  const RecognizedSurface* stand_in = in.face.recognized.get();
  if (stand_in && !std::holds_alternative<BsplineSurface>(stand_in->surface.geometry)) stand_in = nullptr;
  for (BezierPatch& patch : bezier_patches(surface, in.boundary.uv_box))
    patches.push_back(
        {std::move(patch), stand_in ? stand_in->deviation : 0, stand_in ? stand_in->normal_deviation : 0});
  if (!patches.empty()) return patches;
  result.rational = false;
  patches = fitted_patches(surface, in.boundary.uv_box, in.tolerance, in.normal_tolerance);
  result.defined = !patches.empty();
  return patches;
}

}  // namespace

PatchFaceResult make_patch_face(const PatchFaceInput& in, PartDps& out) {
  PatchFaceResult result;
  const std::vector<FittedPatch> patches = patches_of(in, result);
  const std::size_t tasks = (patches.size() + kPatchesPerTask - 1) / kPatchesPerTask;
  std::vector<PartDps> parts(tasks);
  std::vector<int> made(tasks);
  // In parallel over groups of patches; joined in their order, so that the threads' number shows nowhere.
  parallel_for(tasks, [&](std::size_t t) {
    PatchFace face(in, parts[t]);
    for (std::size_t i = t * kPatchesPerTask; i < std::min(patches.size(), (t + 1) * kPatchesPerTask); ++i)
      face.divide_patch(patches[i]);
    made[t] = face.made();
  });
  for (std::size_t t = 0; t < tasks; ++t) {
    append(parts[t], out);
    result.dps += made[t];
  }
  return result;
}

}  // namespace dupin
