// One polynomial for a block of a spline's knot spans, with a bound on what it is off.
//
// Splines have a patch for each knot span, however little the surface does there. The block, grown by a
// margin, is interpolated by a biquintic; the difference to each span's own polynomial is a polynomial too,
// whose Bernstein coefficients bound it and its derivatives. So the margin's strips, which lie across knots,
// are within the bound as well.
#ifndef DUPIN_SAMPLING_MERGED_PATCHES_H
#define DUPIN_SAMPLING_MERGED_PATCHES_H

#include <optional>

#include "knot_strips.h"

namespace dupin {

/// Of a block's width: as far as a merged patch's bounds may hold beyond it.
inline constexpr double kMergedMargin = 0.12;

/// Columns [u0,u1) and rows [v0,v1) of a grid.
struct SpanBlock {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0;
};

struct MergedPatch {
  BezierPatch patch;
  double margin[4] = {};  ///< beyond v = 0, u = 1, v = 1, u = 0, of its width: how far the bounds hold
  Remainder beyond;       ///< of the difference to the surface; derivatives by the patch's own parameters
};

/// Whether blocks of the grid can be merged: its patches are polynomials of one degree, and parameters no
/// angles.
bool is_mergeable(const KnotStrips& grid);

/// None where it is off by more than `tolerance`.
std::optional<MergedPatch> merged_patch(const KnotStrips& grid, const SpanBlock& block, double tolerance);

}  // namespace dupin

#endif
