// From arcs in space to the region of a DP: boundary pieces in the DP's tangent plane, and where they are too
// many, several DPs with smaller footprints.
#ifndef DUPIN_SAMPLING_CHART_REGION_H
#define DUPIN_SAMPLING_CHART_REGION_H

#include <functional>
#include <span>
#include <vector>

#include "boundary.h"
#include "quadric_dp.h"

namespace dupin {

/// More boundary pieces than this in one footprint cost a frame more than another proxy does.
inline constexpr int kMaxPieces = 12;

/// Pieces in a DP's (x,y).
struct ChartPieces {
  std::vector<LinePiece> lines;
  std::vector<ArcPiece> arcs;
  std::vector<EllipsePiece> ellipses;
  std::size_t count() const { return lines.size() + arcs.size() + ellipses.size(); }
  bool empty() const { return count() == 0; }
};

/// Projects arcs into the tangent plane of `dp`, only those parts of them that lie on the sheet where the
/// quadric is a graph (∂F/∂z > 0), and that may meet its footprint.
class ChartProjector {
 public:
  explicit ChartProjector(const QuadricDp& dp);
  /// Whether anything of it was added.
  bool add(const FaceArc& arc, ChartPieces& out);
  void add(const WholeEllipse& ellipse, ChartPieces& out) const;
  Vec2 to_chart(const Vec3& p) const;
  Vec3 to_local(const Vec3& p) const;

 private:
  void add_on_sheet(const ConicArc3& arc, bool feature, ChartPieces& out) const;
  const QuadricDp& dp_;
  Vec3 n_, sheet_normal_;
  double sheet_offset_;
  bool single_sheet_;
  Box2 footprint_box_;
  std::vector<ConicArc3> clipped_;
};

/// Whether the convex quadrilateral and the piece's hull may meet (a separating line among the
/// quadrilateral's sides and the axes was not found).
bool may_meet(const std::array<Vec2, 4>& quad, std::span<const Vec2> hull);

/// An estimate of how far p is from the nearest piece: a reference is best kept away from them.
double clearance(const ChartPieces& pieces, Vec2 p);

/// The state of p, given the state of `reference` and pieces complete along the segment between them.
bool state_at(const ChartPieces& pieces, Vec2 reference, bool reference_state, Vec2 p);

/// Appends the DP with these pieces to `out`, `reference_state` being whether `reference` itself is inside.
void emit_dp(const QuadricDp& dp, const ChartPieces& pieces, Vec2 reference, bool reference_state,
             PartDps& out);

/// The same for a DP that is exact everywhere: where pieces are too many, its footprint is halved until they
/// are not, parts without a piece that lie outside being left out. `dp.footprint` must be a rectangle.
/// Returns the number of DPs.
int emit_exact_dp(const QuadricDp& dp, const ChartPieces& pieces, Vec2 reference, bool reference_state,
                  PartDps& out);

}  // namespace dupin

#endif
