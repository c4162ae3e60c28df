// A piece of a Bézier patch as polynomials of low degree with a remainder, over the piece and its margins.
#ifndef DUPIN_SAMPLING_CELL_MODEL_H
#define DUPIN_SAMPLING_CELL_MODEL_H

#include <array>

#include "../nurbs/bezier.h"
#include "series.h"

namespace dupin {

/// A cell is a patch over its own [0,1]². Its certificate holds on the cell grown by a part of its width on
/// every side (not across a collapsed one): neighbouring DPs overlap there, so that no crack opens between
/// their sheets.
inline constexpr double kCellMargin = 0.04;
/// A cell is grown by at most this part of itself to make room for its curved sides' chords.
inline constexpr double kMostMargin = 0.35;
/// For the sides v = 0, u = 1, v = 1, u = 0.
struct CellMargins {
  double side[4] = {kCellMargin, kCellMargin, kCellMargin, kCellMargin};
};

/// Patches of a higher degree have no model: powers about the centre would lose too many digits.
inline constexpr int kMostModelDegree = 12;

/// S(s,t) − origin over [−1,1]², which is the grown cell.
struct CellModel {
  Vec3 origin;              ///< the grown cell's centre
  std::array<Series, 3> p;  ///< along the model's axes
  Remainder r;              ///< of the vector: its length, and its derivatives'
};

/// False if a weight may vanish, or the degree is too high.
bool make_model(const BezierPatch& cell, const CellMargins& margins, CellModel& out);

}  // namespace dupin

#endif
