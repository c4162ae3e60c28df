// What a frame draws of placed point trees, and what shading needs of those points and triangles that are
// seen.
#ifndef DUPIN_RENDER_TREE_LISTS_H
#define DUPIN_RENDER_TREE_LISTS_H

#include <memory>
#include <vector>

#include "layer.h"
#include "mesh_arena.h"
#include "occlusion.h"
#include "part_camera.h"
#include "point_cut.h"
#include "seen_numbers.h"
#include "tree_layer.h"

namespace dupin {

/// Of a point that is seen. A leaf bends as its parent does: `curvature` is the parent's, times `size` (the
/// highest 8 bits: 255 for a node's own) as the leaf is smaller, and its axis counts from `normal`, the
/// parent's. The face is its number among the part's drawn ones; with kOverride its color is the host's, not
/// the tree's.
struct PointExtra {
  std::uint32_t curvature, node, face, normal;
};
struct DrawnTriangle {
  std::uint32_t triangle, face;
};

/// One tree in one place, and what is drawn of it. Numbers are consecutive over a placement's points, and,
/// four for each, over its leaves.
struct PlacedTree {
  std::size_t tree = 0;  ///< the part
  std::uint32_t instance = 0;
  PointCut cut;
  CutView view{};
  PartCamera camera{};
  PictureExtent extent{};

  /// The cut's lists, numbered from 0; hidden faces left out.
  std::vector<SplatList> points{}, leaves{};
  std::vector<std::uint32_t> visible_points{}, visible_leaves{};  ///< where some faces are hidden
  std::size_t point_count = 0, leaf_count = 0, triangle_count = 0;
  FaceColors look{};                            ///< as the lists were found
  bool found = false;                           ///< they hold what the cut says
  std::uint64_t loaded = 0;                     ///< MeshArena::generation() that has their triangles; 0: none
  std::size_t first_point = 0, first_leaf = 0;  ///< of the frame's
};

/// A placement's consecutive numbers, of points or of triangles: a texel of `runs`.
struct TreeRun {
  std::uint32_t first, instance, unused, first_primitive;
};
inline constexpr std::uint32_t kOverride = 0x80000000U;

class TreeLists {
 public:
  TreeLists() = default;
  TreeLists(const Gl& gl, const std::vector<PartTree>& trees, const Scene::Impl& scene, std::uint32_t layer);

  /// Begins a frame: cameras, and the order in which trees are drawn, nearest first.
  void begin(const LayerPass& pass, const TreeLayerOptions& options);
  /// The frame's trees, indices into placed().
  const std::vector<std::size_t>& order() const { return order_; }
  /// Finds the cuts of some of them, which are drawn next, and lists them anew where cuts or looks have
  /// changed.
  /// What `occlusion` hides of them is left out, if there is one.
  void update(const LayerPass& pass, std::span<const std::size_t> batch, const TreeLayerOptions& options,
              const Occlusion* occlusion);
  /// When all are drawn: what the shader needs of those that are seen, in the order of their new numbers.
  void gather(const Scene::Impl& scene, const SeenNumbers& seen);

  const std::vector<PlacedTree>& placed() const { return placed_; }
  /// Those drawn so far, in their order.
  const std::vector<std::size_t>& drawn() const { return drawn_; }
  std::size_t point_count() const { return point_count_; }
  std::size_t leaf_count() const { return leaf_count_; }
  std::size_t triangle_count() const { return triangle_count_; }
  const MeshArena& arena() const { return arena_; }

  // Of what is seen.
  const std::vector<EncodedNode>& points() const { return points_; }
  const std::vector<PointExtra>& extras() const { return extras_; }
  const std::vector<DrawnTriangle>& triangles() const { return triangles_; }
  const std::vector<TreeRun>& point_runs() const { return point_runs_; }
  const std::vector<TreeRun>& triangle_runs() const { return triangle_runs_; }

  double cut_ms = 0;  ///< of this frame's updates

 private:
  using Indices = std::vector<std::uint32_t>;
  void find_lists(const Scene::Impl& scene, PlacedTree& placed) const;
  void place_camera(const LayerPass& pass, const SidePlanes& sides, const CutOptions& cut,
                    PlacedTree& placed);
  void load_triangles(std::span<const std::size_t> batch);
  void load_seen(const NumberSet& seen);
  void gather_points(const Scene::Impl& scene, const PlacedTree& placed, const NumberSet& seen);
  void gather_triangles(const Scene::Impl& scene, const PlacedTree& placed, const NumberSet& seen);
  std::uint32_t group_of_node(const PlacedTree& placed, std::uint32_t node) const;
  std::uint32_t group_of_leaf(const PlacedTree& placed, std::uint32_t rank) const;
  Indices faces_of(const Scene::Impl& scene, const PlacedTree& placed) const;
  void make_runs(const Scene::Impl& scene, const SeenNumbers& seen);

  std::vector<PartTree> trees_;
  std::uint32_t layer_ = 0;
  std::vector<PlacedTree> placed_;
  std::vector<std::size_t> order_, drawn_;
  std::size_t point_count_ = 0, leaf_count_ = 0, triangle_count_ = 0;
  MeshArena arena_;
  std::vector<EncodedNode> points_;
  std::vector<PointExtra> extras_;
  std::vector<DrawnTriangle> triangles_;
  std::vector<TreeRun> point_runs_, triangle_runs_;
};

}  // namespace dupin

#endif
