// A quadric DP for a cell given as polynomials with remainders (cell_model.h), and the proof of how far it is
// off.
//
// The quadric does not osculate at some point: the difference is economised, in the Chebyshev sense, over the
// cell. A cubic s³ becomes ¼ T₃(s): a quarter of the error, and fewer than half as many cells.
#ifndef DUPIN_SAMPLING_GRAPH_CELL_H
#define DUPIN_SAMPLING_GRAPH_CELL_H

#include "bezier_cell.h"

namespace dupin {

/// As CellFitter::fit, in a fraction of its time, for a patch without a collapsed side whose degrees are at
/// most kMostModelDegree. Where a cell is not valid it says into how many pieces to cut it.
CellFit fit_graph(const BezierPatch& cell, const CellRequest& request);

}  // namespace dupin

#endif
