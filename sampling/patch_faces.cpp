#include "patch_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "../core/parallel.h"
#include "bezier_cell.h"
#include "chart_region.h"
#include "fitted_patches.h"
#include "graph_cell.h"
#include "knot_strips.h"
#include "merged_patches.h"
#include "thin_spans.h"

namespace dupin {
namespace {

/// Halvings of one Bézier patch; a cell that is still too wrong then is reported by its bounds.
constexpr int kMaxDepth = 36;

/// What cells beside an edge may be off, as a part of the tolerance.
constexpr double kBesideEdges = 0.9;

/// A cell smaller than this part of the tolerance is not worth a fit: it is drawn flat.
constexpr double kSpeck = 0.5;
/// What the margin of a thin cell has to leave for the overlap with its neighbours, in terms of its width.
constexpr double kThinOverlap = 0.02;
/// Of the tolerance: what a merged patch may differ from the surface.
constexpr double kMergedShare = 0.3;
/// Blocks of knot spans that one thread merges at a time: at most so many on a side.
constexpr int kMostTile = 32, kLeastTile = 4;
/// A surface whose normal turns at once by more than this part of what is allowed has a crease.
constexpr double kCrease = 0.5;
/// Patches that one thread divides at a time.
constexpr std::size_t kPatchesPerTask = 8;

struct Cell {
  BezierPatch patch;
  Box2 own{{0, 0}, {1, 1}};  ///< in the root patch's parameters
  std::vector<const FaceArc*> arcs;
  bool known = false, inside = false;  ///< no trim in it: wholly in or out
  int depth = 0;
  double excess = 0;  ///< of the cell that this is a piece of, where it was cut in one direction only
  bool cut_u = false;
};
/// ∂F/∂z where a footprint reaches over its grown cell; and by how many times the quadric's own bend the
/// normals may turn there, the drawn one and the surface's.
constexpr double kLeastSheetBeyond = 0.25, kBendsBeyond = 6;
/// A cut that leaves more than this of what asked for it went in the wrong direction.
constexpr double kNoProgress = 0.7;

Box2 shifted(const Box2& box, double du, double dv) {
  return {box.lo + Vec2{du, dv}, box.hi + Vec2{du, dv}};
}

/// By side: whether the surface goes on across it.
using Seams = std::array<bool, 4>;
Seams seams_of(const PatchFaceInput& in) {
  Seams seams{};
  const Box2& box = in.boundary.uv_box;
  const Vec2 eps = box.size() * 1e-6;
  for (const Loop& loop : in.face.loops)
    for (const Trim& trim : loop) {
      if (!is_inner_seam(in.face, trim)) continue;
      const Edge& edge = in.part.edges[trim.edge];
      const Vec2 p = point_at(trim.pcurve, (edge.t0 + edge.t1) / 2);
      seams[0] |= std::abs(p.y - box.lo.y) <= eps.y, seams[1] |= std::abs(p.x - box.hi.x) <= eps.x;
      seams[2] |= std::abs(p.y - box.hi.y) <= eps.y, seams[3] |= std::abs(p.x - box.lo.x) <= eps.x;
    }
  return seams;
}

class PatchFace {
 public:
  PatchFace(const PatchFaceInput& in, const Seams& seams, const KnotStrips* strips, PartDps& out)
      : in_(in),
        out_(out),
        surface_(in.part.surfaces[in.face.surface]),
        period_u_(period_u(surface_)),
        period_v_(period_v(surface_)),
        seam_(seams),
        strips_(strips) {}

  std::vector<const FaceArc*> all_arcs() const {
    std::vector<const FaceArc*> arcs;
    for (const FaceLoop& loop : in_.boundary.loops)
      for (const FaceArc& arc : loop.arcs) arcs.push_back(&arc);
    return arcs;
  }

  void divide_patch(const FittedPatch& fitted, std::size_t index, std::vector<const FaceArc*> arcs) {
    fitted_position_ = fitted.position_error, fitted_normal_ = fitted.normal_error;
    root_ = fitted.patch, root_index_ = index;
    for (auto& strip : strip_cache_) strip.reset();
    Cell cell;
    cell.patch = fitted.patch;
    cell.arcs = std::move(arcs);
    divide(cell);
  }

  /// Blocks of knot spans that one DP can do for, or else their halves.
  void divide_block(const std::vector<FittedPatch>& patches, const SpanBlock& b,
                    std::vector<const FaceArc*> arcs) {
    const int columns = b.u1 - b.u0, rows = b.v1 - b.v0;
    if (columns == 1 && rows == 1) {
      const auto i = static_cast<std::size_t>(strips_->index(b.u0, b.v0));
      return divide_patch(patches[i], i, std::move(arcs));
    }
    Cell cell;
    cell.arcs = std::move(arcs);
    if (emit_block(b, cell)) return;
    SpanBlock first = b, second = b;
    if (rows == 1 || (columns > 1 && is_longer_along_u(b)))
      first.u1 = second.u0 = (b.u0 + b.u1) / 2;
    else
      first.v1 = second.v0 = (b.v0 + b.v1) / 2;
    divide_block(patches, first, cell.arcs);
    divide_block(patches, second, std::move(cell.arcs));
  }

  /// What any of the patches is off already.
  void note_errors(const std::vector<FittedPatch>& patches) {
    for (const FittedPatch& p : patches) {
      worst_position_ = std::max(worst_position_, p.position_error);
      worst_normal_ = std::max(worst_normal_, p.normal_error);
    }
  }

  int made() const { return made_; }

 private:
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
    CellRequest request{tolerance - fitted_position_, in_.normal_tolerance - fitted_normal_, {}, {}};
    CellFit fit = fit_cell(cell.patch, request);
    if (fit.valid && emit(cell, uv, request, fit)) return;
    if (fit.valid && widen_margins(fit)) {
      request.margins = fit.margins;
      CellFit wider = fit_cell(cell.patch, request);
      if (wider.valid && emit(cell, uv, request, wider)) return;
    }
    if (speck) return emit_speck(cell, uv, box, fit);
    if (fit.valid) cut_bent_sides(fit);
    turn_useless_cut(cell, fit);
    split(cell, fit);
  }

  /// Along the sides that are too curved for their chords; where that is not what is wrong, both ways.
  static void cut_bent_sides(CellFit& fit) {
    const double* needed = fit.margin_needed;
    const bool along_u = std::max(needed[0], needed[2]) > kMostMargin,
               along_v = std::max(needed[1], needed[3]) > kMostMargin;
    fit.pieces_u = along_u || !along_v ? 2 : 1, fit.pieces_v = along_v || !along_u ? 2 : 1;
  }

  static void turn_useless_cut(const Cell& cell, CellFit& fit) {
    if (!(cell.excess > 0) || !(fit.excess > kNoProgress * cell.excess)) return;
    fit.pieces_u = cell.cut_u ? 1 : std::max(fit.pieces_u, 2);
    fit.pieces_v = cell.cut_u ? std::max(fit.pieces_v, 2) : 1;
  }

  CellFit fit_cell(const BezierPatch& patch, const CellRequest& request) {
    const CollapsedSides c = collapsed_sides(patch);
    const bool collapsed = c.u0 || c.u1 || c.v0 || c.v1;
    if (collapsed || patch.degree_u > kMostModelDegree || patch.degree_v > kMostModelDegree)
      return fitter_.fit(patch, request);
    return fit_graph(patch, request);
  }

  void split(Cell& cell, const CellFit& fit) {
    const int along_u = fit.pieces_u, along_v = fit.pieces_v;
    std::vector<BezierPatch> patches = split_patch(cell.patch, along_u, along_v);
    cell.patch.poles.clear();
    const Vec2 size = cell.own.size();
    for (int i = 0; i < along_u; ++i)
      for (int j = 0; j < along_v; ++j) {
        Cell piece;
        piece.patch = std::move(patches[static_cast<std::size_t>(i * along_v + j)]);
        piece.own = {{cell.own.lo.x + size.x * i / along_u, cell.own.lo.y + size.y * j / along_v},
                     {i + 1 < along_u ? cell.own.lo.x + size.x * (i + 1) / along_u : cell.own.hi.x,
                      j + 1 < along_v ? cell.own.lo.y + size.y * (j + 1) / along_v : cell.own.hi.y}};
        piece.arcs = cell.arcs;
        piece.known = cell.known, piece.inside = cell.inside;
        if (along_u == 1 || along_v == 1) piece.excess = fit.excess, piece.cut_u = along_u > 1;
        piece.depth = cell.depth + (along_u * along_v > 2 ? 2 : 1);
        divide(piece);
      }
  }

  bool emit(const Cell& cell, const Box2& uv, const CellRequest& request, CellFit& fit) {
    return make_footprint(uv, fit) && add_overshoot(request, fit) && add_strips(cell, uv, request, fit) &&
           emit_fit(cell, uv, fit);
  }

  /// Beside a collapsed side, where the grown cell has no width, the footprint reaches over it. What is drawn
  /// there is as far as that from a place where the certificate holds, and its normal has turned, and the
  /// surface's, by no more than both curvatures make of it.
  static bool add_overshoot(const CellRequest& request, CellFit& fit) {
    if (!(fit.overshoot > 0)) return true;
    QuadricDp& dp = fit.dp;
    double x = 0, y = 0;
    for (Vec2 p : dp.footprint) x = std::max(x, std::abs(p.x)), y = std::max(y, std::abs(p.y));
    const double z = std::max(std::abs(dp.z_lo), std::abs(dp.z_hi)) + fit.overshoot;
    const double gz = 1 - std::abs(dp.a) * x - std::abs(dp.b) * y - std::abs(dp.c) * z;
    if (!(gz > kLeastSheetBeyond)) return false;
    const double slope = std::hypot(std::abs(dp.lambda_u) * x + std::abs(dp.a) * z,
                                    std::abs(dp.lambda_v) * y + std::abs(dp.b) * z) /
                         gz;
    const double r = std::hypot(x, y);
    double cubic = 0;
    for (double c : dp.cubic) cubic += 6 * std::abs(c) * r;
    const double bend = (std::max(std::abs(dp.lambda_u), std::abs(dp.lambda_v)) + cubic +
                         2 * std::hypot(dp.a, dp.b) * slope + std::abs(dp.c) * slope * slope) /
                        gz;
    const double off = fit.overshoot * std::hypot(1, slope);
    fit.bound += off, fit.dp.z_lo -= off, fit.dp.z_hi += off;
    fit.normal_bound += kBendsBeyond * bend * fit.overshoot;
    return fit.bound <= request.tolerance && fit.normal_bound <= request.normal_tolerance;
  }

  bool emit_fit(const Cell& cell, const Box2& uv, const CellFit& fit) {
    QuadricDp dp = fit.dp;
    dp.face = in_.face_index;
    dp.cell = uv;
    dp.bound = fit.bound + fitted_position_, dp.normal_bound = fit.normal_bound + fitted_normal_;
    dp.sampled_bound = fitted_position_ > 0 && !std::holds_alternative<BsplineSurface>(surface_.geometry);
    dp.flipped = in_.face.reversed;
    return emit_region(cell, uv, dp);
  }

  const BezierPatch& span(int column, int row) const {
    return strips_->patch(static_cast<std::size_t>(strips_->index(column, row)));
  }

  bool is_longer_along_u(const SpanBlock& b) const {
    const auto corner = [&](bool u, bool v) {
      const BezierPatch& p = span(u ? b.u1 - 1 : b.u0, v ? b.v1 - 1 : b.v0);
      return point_at(p, u ? 1 : 0, v ? 1 : 0);
    };
    return distance(corner(false, false), corner(true, false)) +
               distance(corner(false, true), corner(true, true)) >=
           distance(corner(false, false), corner(false, true)) +
               distance(corner(true, false), corner(true, true));
  }

  /// True if nothing is left to do for the block: one DP was enough, or none is needed.
  bool emit_block(const SpanBlock& b, Cell& cell) {
    const Box2 uv{{strips_->column_start(b.u0), strips_->row_start(b.v0)},
                  {strips_->column_start(b.u1), strips_->row_start(b.v1)}};
    filter_arcs(cell, uv);
    if (cell.known && !cell.inside) return true;
    Box3 box;
    for (int c = b.u0; c < b.u1; ++c)
      for (int r = b.v0; r < b.v1; ++r) {
        const Box3 one = poles_box(span(c, r));
        box.add(one.lo), box.add(one.hi);
      }
    const double allowed = in_.tolerance.at(box);
    if (std::isinf(allowed)) return true;
    allowed_ = allowed, fitted_position_ = worst_position_, fitted_normal_ = worst_normal_;
    if (box.diagonal() <= kSpeck * allowed) return emit_speck_block(b, cell, uv, box), true;
    const double tolerance = allowed * (!cell.known ? kTrimTolerance : cell.arcs.empty() ? 1 : kBesideEdges);
    std::optional<MergedPatch> merged = merged_patch(*strips_, b, kMergedShare * tolerance);
    if (!merged) return false;
    root_ = cell.patch = std::move(merged->patch);
    // The fit's parameters run over [−1,1], margins included.
    const double half = (1 + 2 * kMergedMargin) / 2;
    const Remainder& d = merged->beyond;
    const CellRequest request{tolerance, in_.normal_tolerance, {}, {d.value, d.ds * half, d.dt * half}};
    CellFit fit = fit_cell(cell.patch, request);
    if (!fit.valid || !make_footprint(uv, fit) || !add_overshoot(request, fit)) return false;
    const double gradient[2] = {fit.gradient_t, fit.gradient_s};
    for (int k = 0; k < 4; ++k)
      if (!on_border(k, uv) && !(fit.overrun[k] * gradient[k % 2] <= merged->margin[k])) return false;
    return emit_fit(cell, uv, fit);
  }

  /// By its corners; the box says what that may be off.
  void emit_speck_block(const SpanBlock& b, Cell& cell, const Box2& uv, const Box3& box) {
    BezierPatch& flat = cell.patch;
    flat.degree_u = flat.degree_v = 1, flat.domain = uv;
    flat.poles = {span(b.u0, b.v0).poles.front(), span(b.u0, b.v1 - 1).pole(0, span(b.u0, b.v1 - 1).degree_v),
                  span(b.u1 - 1, b.v0).pole(span(b.u1 - 1, b.v0).degree_u, 0),
                  span(b.u1 - 1, b.v1 - 1).poles.back()};
    root_ = flat;
    emit_speck(cell, uv, box, {});
  }

  const SideStrip& strip(int side, int next_to = -1) {
    // Of the patch over `side`, its own side `next_to`: two such for each.
    const int slot = next_to < 0 ? side : 4 + 2 * side + (next_to > 1 ? 1 : 0);
    std::optional<SideStrip>& cached = strip_cache_[static_cast<std::size_t>(slot)];
    if (cached) return *cached;
    const int other = strips_->neighbour(root_index_, side);
    if (next_to < 0)
      cached = strips_->strip(root_index_, side);
    else
      cached = other < 0 ? SideStrip{} : strips_->strip(static_cast<std::size_t>(other), next_to);
    return *cached;
  }

  /// What lies over the root's sides is the neighbouring patches, not this one carried on: added to the
  /// bounds. Not over creases, where the surface ends as at an edge, nor over patches that are thinner than
  /// the tolerance.
  bool add_strips(const Cell& cell, const Box2& uv, const CellRequest& request, CellFit& fit) {
    if (!strips_ || !(fit.gradient_s > 0)) return true;
    const bool at_border[4] = {cell.own.lo.y <= 0, cell.own.hi.x >= 1, cell.own.hi.y >= 1,
                               cell.own.lo.x <= 0};
    // Of the root's parameters.
    const double gradient[2] = {fit.gradient_t * cell.own.size().y, fit.gradient_s * cell.own.size().x};
    double sigma[4] = {};
    for (int k = 0; k < 4; ++k)
      if (at_border[k] && !on_border(k, uv) && gradient[k % 2] * allowed_ < 1)
        sigma[k] = fit.overrun[k] * gradient[k % 2];
    double off = 0, turn = 0;
    for (int k = 0; k < 4; ++k) {
      if (!(sigma[k] > 0)) continue;
      const double across = gradient[k % 2], along = gradient[(k + 1) % 2];
      const double beside = std::max(sigma[(k + 1) % 4], sigma[(k + 3) % 4]);
      add_strip(strip(k), sigma[k], fit.overrun[k], across, along, stretch(k, beside), off, turn);
      if (k % 2 == 1)  // in the corner, the neighbour's own neighbour
        for (int l : {0, 2})
          if (sigma[l] > 0)
            add_strip(strip(k, l), sigma[l], fit.overrun[l], along, across * speed_over(k),
                      stretch(l, sigma[k]), off, turn);
    }
    fit.bound += off, fit.dp.z_lo -= off, fit.dp.z_hi += off;
    fit.normal_bound += turn < 0.5 ? std::asin(turn / (1 - turn)) : 4;
    return fit.bound <= request.tolerance && fit.normal_bound <= request.normal_tolerance;
  }

  /// A side's bounds hold along it; so much more where the polynomials are carried on in that direction.
  double stretch(int side, double beside) const {
    const int degree = side % 2 == 1 ? root_.degree_v : root_.degree_u;
    return std::pow(1 + 2 * beside, root_.rational ? 2 * degree : degree);
  }

  void add_strip(const SideStrip& strip, double sigma, double overrun, double across, double along,
                 double stretch, double& off, double& turn) const {
    if (strip.smooth) return;
    const Remainder r = strip.at(sigma) * stretch;
    if (strip.crease() * across > kCrease * in_.normal_tolerance) {
      off += std::min(r.value, overrun);
      return;
    }
    off += r.value, turn += r.ds * across + r.dt * along;
  }

  /// The root's width over the neighbour's.
  double speed_over(int side) const {
    const int other = strips_->neighbour(root_index_, side);
    return other < 0
               ? 1
               : root_.domain.size().x / strips_->patch(static_cast<std::size_t>(other)).domain.size().x;
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
    bool reached = true, is_point[4];
    for (int k = 0; k < 4; ++k) is_point[k] = length(c[(k + 1) % 4] - c[k]) <= 1e-9 * size;
    fit.overshoot = 0;
    for (int k = 0; k < 4; ++k) {
      const Vec2 a = c[k], d = c[(k + 1) % 4] - a;
      const bool point = is_point[k];
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
        reach -= fit.border_slack;
        // A cell that is thinner than its bound cannot overlap by it: its neighbours do.
        const double needed = std::min(fit.bound + 1e-5 * size, kThinOverlap * (bulge - own));
        if (is_point[(k + 1) % 4] || is_point[(k + 3) % 4]) {
          overlap_width = std::max(needed, std::min(wanted, reach - bulge));
          fit.overshoot = std::max(fit.overshoot, bulge + overlap_width - reach);
          fit.margin_needed[k] = bulge > needed ? 1e300 : 0;
        } else {
          if (!(reach - bulge >= needed)) reached = false;
          overlap_width = std::min(wanted, reach - bulge);
        }
      }
      lines[k] = {a + out * (bulge + overlap_width), out};
      double depth = 0;
      for (Vec2 p : fit.border[k]) depth = std::min(depth, dot(p - a, out));
      fit.overrun[k] = bulge + overlap_width - depth;
    }
    if (!reached) return false;
    for (int k = 0; k < 4; ++k)
      if (!meet(lines[(k + 3) % 4], lines[k], fit.dp.footprint[k])) return false;
    for (int k = 0; k < 4 && fit.overshoot > 0; ++k)
      for (int end : {k, (k + 1) % 4})  // over a border trims end it
        if (is_point[k] && !on_border(end == k ? (k + 3) % 4 : end, uv))
          fit.overshoot = std::max(fit.overshoot, length(fit.dp.footprint[end] - c[k]));
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
    // The arcs' tolerance is that of their own place, which may be farther from the camera than the cell's.
    const double both = std::hypot(dp.bound, off);
    if (both > allowed_ && !dp.speck && cell.depth < kMaxDepth / 2) return false;
    dp.bound = both;
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
  const Seams& seam_;
  const KnotStrips* strips_;  ///< null: the patches are no neighbours of each other
  std::size_t root_index_ = 0;
  std::array<std::optional<SideStrip>, 12>
      strip_cache_;  ///< the root's sides; the sides next to them of its neighbours
  BezierPatch root_;
  CellFitter fitter_;
  double fitted_position_ = 0, fitted_normal_ = 0;  ///< what an interpolated patch is off already
  double worst_position_ = 0, worst_normal_ = 0;    ///< of all patches
  double allowed_ = 0;                              ///< the tolerance where the present cell is
  int made_ = 0;
};

/// Trims that miss a knot by a rounding error leave spans without a width, of the box's this part at most.
constexpr double kSliver = 5e-10;
void drop_slivers(std::vector<FittedPatch>& patches, const Box2& box) {
  const Vec2 least = box.size() * kSliver;
  const auto is_wide = [&](const FittedPatch& p) {
    return p.patch.domain.size().x > least.x && p.patch.domain.size().y > least.y;
  };
  if (std::any_of(patches.begin(), patches.end(), is_wide))
    std::erase_if(patches, [&](const FittedPatch& p) { return !is_wide(p); });
}

/// Of what is allowed: what carrying on a patch over a thin span may be off.
constexpr double kThinShare = 0.2, kThinNormals = 0.1;
ThinSpanTolerances thin_span_tolerances(const PatchFaceInput& in, const std::vector<FittedPatch>& patches) {
  Box3 box;
  for (const FittedPatch& p : patches) {
    const Box3 one = poles_box(p.patch);
    box.add(one.lo), box.add(one.hi);
  }
  return {in.tolerance.at(box) * kTrimTolerance * kThinShare, in.normal_tolerance * kThinNormals};
}

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
  drop_slivers(patches, in.boundary.uv_box);
  if (patches.size() > 1 && !stand_in && std::holds_alternative<BsplineSurface>(surface.geometry))
    absorb_thin_spans(patches, thin_span_tolerances(in, patches));
  if (!patches.empty()) return patches;
  result.rational = false;
  patches = fitted_patches(surface, in.boundary.uv_box, in.tolerance, in.normal_tolerance);
  result.defined = !patches.empty();
  return patches;
}

std::optional<KnotStrips> strips_of(const PatchFaceInput& in, const Seams& seams, bool rational,
                                    const std::vector<FittedPatch>& patches) {
  if (!rational) return std::nullopt;
  std::vector<const BezierPatch*> all;
  for (const FittedPatch& p : patches) all.push_back(&p.patch);
  const bool whole = in.boundary.loops.empty();
  const Surface& surface = in.part.surfaces[in.face.surface];
  return KnotStrips(std::move(all), seams[1] || seams[3] || (whole && period_u(surface) > 0),
                    seams[0] || seams[2] || (whole && period_v(surface) > 0));
}

std::vector<SpanBlock> tiles_of(const KnotStrips& grid) {
  const int columns = grid.columns(), rows = grid.rows(),
            tile = std::clamp(std::max(columns, rows) / 4, kLeastTile, kMostTile);
  std::vector<SpanBlock> tiles;
  for (int c = 0; c < columns; c += tile)
    for (int r = 0; r < rows; r += tile)
      tiles.push_back({c, std::min(c + tile, columns), r, std::min(r + tile, rows)});
  return tiles;
}

}  // namespace

PatchFaceResult make_patch_face(const PatchFaceInput& in, PartDps& out) {
  PatchFaceResult result;
  const std::vector<FittedPatch> patches = patches_of(in, result);
  if (patches.empty()) return result;
  const Seams seams = seams_of(in);
  const std::optional<KnotStrips> strips = strips_of(in, seams, result.rational, patches);
  const KnotStrips* grid = strips ? &*strips : nullptr;
  std::vector<SpanBlock> tiles;
  if (grid && is_mergeable(*grid)) tiles = tiles_of(*grid);
  const std::size_t tasks =
      tiles.empty() ? (patches.size() + kPatchesPerTask - 1) / kPatchesPerTask : tiles.size();
  std::vector<PartDps> parts(tasks);
  std::vector<int> made(tasks);
  // In parallel over groups of patches; joined in their order, so that the threads' number shows nowhere.
  parallel_for(tasks, [&](std::size_t t) {
    PatchFace face(in, seams, grid, parts[t]);
    face.note_errors(patches);
    if (!tiles.empty())
      face.divide_block(patches, tiles[t], face.all_arcs());
    else
      for (std::size_t i = t * kPatchesPerTask; i < std::min(patches.size(), (t + 1) * kPatchesPerTask); ++i)
        face.divide_patch(patches[i], i, face.all_arcs());
    made[t] = face.made();
  });
  for (std::size_t t = 0; t < tasks; ++t) {
    append(std::move(parts[t]), out);
    result.dps += made[t];
  }
  return result;
}

}  // namespace dupin
