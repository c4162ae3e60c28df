// The meshes of a model as point trees.
#ifndef DUPIN_APP_POINT_TREES_H
#define DUPIN_APP_POINT_TREES_H

#include <memory>
#include <string>
#include <vector>

#include "../core/progress.h"
#include "../nurbs/model.h"
#include "../render/tree_layer.h"

namespace dupin::app {

/// What the files had of trees, and where to keep those that are made.
struct KnownTrees {
  std::vector<std::shared_ptr<const PointTree>> trees;
  std::vector<std::string> files;
};

struct TreeRequest {
  PointTreeKind kind = PointTreeKind::pop;
  bool faces = false;  ///< exact faces too, from their tessellation
  Progress progress;
};

/// One entry a part; null where there is nothing to make a tree of. That a tree could not be kept is no
/// failure.
Result<std::vector<PartTree>> make_point_trees(const Model& model, const KnownTrees& known,
                                               const TreeRequest& request);

/// A part's tessellation with its faces as groups, and its polygons.
PolygonMesh tessellation(const Part& part);

/// All that a model holds, where it stands, with its faces as groups; a single part in its own space.
struct PlacedMesh {
  PolygonMesh mesh;
  double scale = 1;  ///< to model space
};
PlacedMesh placed_mesh(const Model& model);

}  // namespace dupin::app

#endif
