// Drawing point trees: points where they are small on the screen, triangles where they are not, in one pass.
#ifndef DUPIN_RENDER_TREE_LAYER_H
#define DUPIN_RENDER_TREE_LAYER_H

#include <memory>
#include <vector>

#include "../simplify/point_tree.h"

namespace dupin {

class Layer;

struct TreeLayerOptions {
  double threshold_px = 1;  ///< the largest diameter, on the screen, of what is drawn as a point
  bool silhouette = false;  ///< triangles wherever normals are almost perpendicular to the view
  bool leaves_as_points =
      true;  ///< also the smallest nodes are points below the threshold; else always triangles, as published
  bool reconstruct =
      false;  ///< visibility splatting: points of one pixel, and what is between them filled from around
  bool foreshortened = true;  ///< discs seen at a slant are narrow; else circles, as published
  bool occlusion = true;      ///< leave out placements that nearer ones hide; the picture is the same
  bool coherent = true;       ///< a frame starts from the last one's nodes; the picture is the same
};

/// What the last frame did.
struct TreeLayerStats {
  std::uint64_t points = 0, triangles = 0;  ///< drawn, in all placements
  std::uint64_t visited = 0;                ///< nodes whose bounds were looked at
  std::uint64_t hidden = 0;                 ///< placements in view that nearer ones hide
  double cut_ms = 0, gather_ms = 0, raster_ms = 0;
};

struct PartTree {
  std::shared_ptr<const PointTree> tree;  ///< null for parts that something else draws
  std::uint32_t first_face = 0;           ///< the tree's groups are the part's faces from this one on
};

/// One tree a part of the model. Trees are walked where they lie: only what frames need of them is read and
/// uploaded.
class TreeLayers {
 public:
  TreeLayers(std::vector<PartTree> trees, const TreeLayerOptions& options);
  ~TreeLayers();
  /// For SceneContent::layers. May be in several scenes, one after the other, but draws one at a time.
  std::shared_ptr<Layer> layer() const;
  TreeLayerStats stats() const;
  /// ok, or what was found damaged in a tree's file while it was drawn.
  Status damage() const;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace dupin

#endif
