// Models that a host makes in memory, from its own surfaces and curves.
#ifndef DUPIN_HOST_COMPLETE_MODEL_H
#define DUPIN_HOST_COMPLETE_MODEL_H

#include "../core/status.h"
#include "../nurbs/model.h"

namespace dupin {

/// Fills in what follows from the rest: every part's box; one instance of each part, where the model has no
/// instances at all; four edges around a plane's face without loops; what is simpler than the spline that
/// stands for it. Then check(model): invalid_argument
/// with the first thing that is wrong, which the host has to put right.
///
/// The host fills in parts with surfaces, edges (curves in space with their ranges) and faces, whose loops
/// refer to edges and have a curve in the surface's parameters for each; a face without loops is its uv_box.
/// `Edge::smooth` and `Part::closed` are what the host says: smooth edges are not drawn as feature lines, and
/// of closed parts the inner sides are not drawn.
Status complete(Model& model);

}  // namespace dupin

#endif
