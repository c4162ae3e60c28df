// What a frame draws of placed point trees, one thing behind the other: points and triangles, each with its
// number's place.
#ifndef DUPIN_RENDER_TREE_LISTS_H
#define DUPIN_RENDER_TREE_LISTS_H

#include <memory>
#include <vector>

#include "mesh_arena.h"
#include "part_camera.h"
#include "point_cut.h"
#include "tree_layer.h"

namespace dupin {

/// One tree in one place.
struct PlacedTree {
  std::size_t tree = 0;  ///< the part
  std::uint32_t instance = 0;
  PointCut cut;
  CutView view;
  PartCamera camera{};
  std::size_t first_point = 0, points = 0, first_triangle = 0, triangles = 0;  ///< of the lists
};

/// A placement's consecutive numbers, of points or of triangles: a texel of `runs`.
struct TreeRun {
  std::uint32_t first, instance, unused, first_primitive;
};
/// The face is its number among the part's drawn ones; with kOverride its color is the host's, not the
/// tree's.
struct PointExtra {
  std::uint32_t curvature, node, face, unused;
};
struct DrawnTriangle {
  std::uint32_t triangle, face;
};
inline constexpr std::uint32_t kOverride = 0x80000000U;

class TreeLists {
 public:
  TreeLists() = default;
  TreeLists(const Gl& gl, const std::vector<PartTree>& trees, const Scene::Impl& scene, std::uint32_t layer);

  /// Finds the cuts for a view.
  void find(const Scene::Impl& scene, const ViewRays& view, std::span<const DrawOptions::Section> sections,
            const TreeLayerOptions& options);
  /// Fills the lists anew if a cut or a look has changed since; whether it did.
  bool gather(const Scene::Impl& scene);

  const std::vector<PlacedTree>& placed() const { return placed_; }
  const MeshArena& arena() const { return arena_; }
  const std::vector<EncodedNode>& points() const { return points_; }
  const std::vector<PointExtra>& extras() const { return extras_; }
  const std::vector<DrawnTriangle>& triangles() const { return drawn_; }
  /// The triangles' indices in the arena.
  const std::vector<std::uint32_t>& triangle_indices() const { return indices_; }
  const std::vector<TreeRun>& point_runs() const { return point_runs_; }
  const std::vector<TreeRun>& triangle_runs() const { return triangle_runs_; }

 private:
  using Indices = std::vector<std::uint32_t>;
  /// A list of nodes or of leaves, and where its first point or triangle goes.
  struct Piece {
    const Indices* list;
    std::size_t at;
  };
  /// What is drawn of one placement, hidden faces left out.
  struct Pieces {
    std::vector<Piece> points, leaves;
    Indices visible_points, visible_leaves;  ///< where some faces are hidden
  };
  Pieces pieces_of(const Scene::Impl& scene, const PlacedTree& placed) const;
  bool looks_changed(const Scene::Impl& scene);
  void number(std::vector<Pieces>& pieces);
  void fill(const Scene::Impl& scene, const PlacedTree& placed, const Pieces& pieces);
  void fill_points(const PlacedTree& placed, const Piece& piece, const Indices& faces);
  void fill_triangles(const PlacedTree& placed, const Piece& piece, const Indices& faces);
  std::uint32_t group_of_node(const PlacedTree& placed, std::uint32_t node) const;
  std::uint32_t group_of_leaf(const PlacedTree& placed, std::uint32_t rank) const;
  Indices faces_of(const Scene::Impl& scene, const PlacedTree& placed) const;
  void make_runs(const Scene::Impl& scene);

  std::vector<PartTree> trees_;
  std::uint32_t layer_ = 0;
  std::vector<PlacedTree> placed_;
  std::vector<FaceColors> looks_;  ///< of each placed tree, as gathered
  bool gathered_ = false;
  MeshArena arena_;
  std::vector<EncodedNode> points_;
  std::vector<PointExtra> extras_;
  std::vector<DrawnTriangle> drawn_;
  Indices indices_;
  std::vector<TreeRun> point_runs_, triangle_runs_;
};

}  // namespace dupin

#endif
