// Models of one part, made by hand.
#ifndef DUPIN_TESTS_EXACT_ONE_FACE_H
#define DUPIN_TESTS_EXACT_ONE_FACE_H

#include "../../nurbs/model.h"

namespace dupin::testing {

/// One part placed once, without faces.
Model empty_model();
/// Adds a face bounded by `uv_box` alone.
Face& add_face(Model& model, const Surface& surface, const Box2& uv_box);
/// Adds a loop of pcurves, each over its own range, as edges of that tolerance whose curves are the pcurves'
/// images where those are straight lines on a plane (none otherwise).
void add_loop(Model& model, std::size_t face, const std::vector<Curve2>& pcurves,
              const std::vector<ParameterRange>& ranges, double tolerance = 0);

}  // namespace dupin::testing

#endif
