// What a frame draws of placed point trees: points and triangles, each with its number's place.
#ifndef DUPIN_RENDER_TREE_LISTS_H
#define DUPIN_RENDER_TREE_LISTS_H

#include <memory>
#include <vector>

#include "layer.h"
#include "mesh_arena.h"
#include "occlusion.h"
#include "part_camera.h"
#include "point_cut.h"
#include "tree_layer.h"

namespace dupin {

/// The face is its number among the part's drawn ones; with kOverride its color is the host's, not the
/// tree's.
struct PointExtra {
  std::uint32_t curvature, node, face, unused;
};
struct DrawnTriangle {
  std::uint32_t triangle, face;
};

/// One tree in one place, and what is drawn of it.
struct PlacedTree {
  std::size_t tree = 0;  ///< the part
  std::uint32_t instance = 0;
  PointCut cut;
  CutView view{};
  PartCamera camera{};
  PictureExtent extent{};
  bool drawn = false;  ///< this frame: visible, and not hidden by others

  std::vector<EncodedNode> points{};
  std::vector<PointExtra> extras{};
  std::vector<DrawnTriangle> triangles{};
  std::vector<std::uint32_t> triangle_indices{};    ///< in the arena
  std::size_t first_point = 0, first_triangle = 0;  ///< of the frame's

  FaceColors look{};    ///< as the lists were filled
  bool filled = false;  ///< they hold what the cut says
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
  /// Finds the cuts of some of them, which are drawn next, and fills their lists where cuts or looks have
  /// changed.
  /// What `occlusion` hides of them is left out, if there is one.
  void update(const LayerPass& pass, std::span<const std::size_t> batch, const TreeLayerOptions& options,
              const Occlusion* occlusion);
  /// When all are there: whether anything that is drawn, or its order, is another than in the last frame.
  bool finish(const Scene::Impl& scene);

  const std::vector<PlacedTree>& placed() const { return placed_; }
  /// Those drawn so far, in their order.
  const std::vector<std::size_t>& drawn() const { return drawn_; }
  std::size_t point_count() const { return point_count_; }
  std::size_t triangle_count() const { return triangle_count_; }
  const MeshArena& arena() const { return arena_; }
  const std::vector<TreeRun>& point_runs() const { return point_runs_; }
  const std::vector<TreeRun>& triangle_runs() const { return triangle_runs_; }

  double cut_ms = 0;  ///< of this frame's updates

 private:
  using Indices = std::vector<std::uint32_t>;
  /// A list of nodes or of leaves, and where its first point or triangle goes.
  struct Piece {
    const Indices* list;
    std::size_t at;
  };
  /// What is drawn of one placement, hidden faces left out. Stays where it is: it points into itself.
  struct Pieces {
    std::vector<Piece> points, leaves;
    Indices visible_points, visible_leaves;  ///< where some faces are hidden
  };
  void find_pieces(const Scene::Impl& scene, const PlacedTree& placed, Pieces& pieces) const;
  void place_camera(const LayerPass& pass, const SidePlanes& sides, const CutOptions& cut,
                    PlacedTree& placed);
  void load_triangles(const Scene::Impl& scene, std::vector<Pieces>& pieces,
                      std::span<const std::size_t> batch);
  void number(PlacedTree& placed, Pieces& pieces);
  void fill(const Scene::Impl& scene, PlacedTree& placed, const Pieces& pieces);
  void fill_points(PlacedTree& placed, const Piece& piece, const Indices& faces);
  void fill_triangles(PlacedTree& placed, const Piece& piece, const Indices& faces);
  std::uint32_t group_of_node(const PlacedTree& placed, std::uint32_t node) const;
  std::uint32_t group_of_leaf(const PlacedTree& placed, std::uint32_t rank) const;
  Indices faces_of(const Scene::Impl& scene, const PlacedTree& placed) const;
  void make_runs(const Scene::Impl& scene);

  std::vector<PartTree> trees_;
  std::uint32_t layer_ = 0;
  std::vector<PlacedTree> placed_;
  std::vector<std::size_t> order_, drawn_, last_drawn_;
  std::size_t point_count_ = 0, triangle_count_ = 0;
  bool refilled_ = false;  ///< some list, in this frame
  MeshArena arena_;
  std::vector<TreeRun> point_runs_, triangle_runs_;
};

}  // namespace dupin

#endif
