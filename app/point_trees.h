// The meshes of a model as point trees.
#ifndef DUPIN_APP_POINT_TREES_H
#define DUPIN_APP_POINT_TREES_H

#include <vector>

#include "../core/progress.h"
#include "../nurbs/model.h"
#include "../render/tree_layer.h"

namespace dupin::app {

struct TreeRequest {
  PointTreeKind kind = PointTreeKind::pop;
  bool faces = false;  ///< exact faces too, from their tessellation
  Progress progress;
};

/// One entry a part; null where there is nothing to make a tree of.
Result<std::vector<PartTree>> make_point_trees(const Model& model, const TreeRequest& request);

/// A part's tessellation with its faces as groups, and its polygons.
PolygonMesh tessellation(const Part& part);

}  // namespace dupin::app

#endif
