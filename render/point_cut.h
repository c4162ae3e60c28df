// Which nodes of a point tree a frame draws: the cut through the tree below which nothing is larger than a
// threshold on the screen, found from the last frame's (Chen & Nguyen 2001, section 3.2).
//
// A node is open if its children are looked at in its place: it is not culled, and larger than the threshold
// (or near the silhouette, where that is asked for). The cut, or front, has the nodes that are not open, or
// leaves, below open ones. Bounds are nested, so whatever is open has open parents only, and the front
// follows from looking at each node of it and its parent. RENDER-COHERENCY does that to all of it; here each
// also keeps how far the camera may move before anything that was decided for it can change (for its size,
// the sides of the picture and its normal cone one each), and is not looked at before that. So a frame's
// front is the same, node by node, as a fresh walk's.
#ifndef DUPIN_RENDER_POINT_CUT_H
#define DUPIN_RENDER_POINT_CUT_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "../simplify/point_tree.h"
#include "part_camera.h"

namespace dupin {

struct CutOptions {
  double threshold_px = 1;  ///< the largest diameter of what is drawn as a point
  bool silhouette =
      false;  ///< go down to the triangles wherever normals are almost perpendicular to the view
  bool leaves_as_points = true;  ///< those below the threshold; else always their triangles, as published
};

/// The camera in a tree's grid.
struct CutView {
  std::array<Plane3, 4> sides;  ///< of the picture, inside positive, normals unit
  Plane3 depth;                 ///< model units
  Vec3 eye;                     ///< or, in parallel, the unit direction towards the viewer
  bool perspective = true;
  bool cull_turned_away = true;
  double pixels_per_step = 1;  ///< of a step's length: in perspective at the depth 1
  CutOptions options;
};
/// `anchor`: what the camera is relative to.
CutView cut_view(const PartCamera& camera, const SceneInstance& instance, const ViewRays& view,
                 const PointGrid& grid, const Vec3& anchor, const CutOptions& options);

class PointCut {
 public:
  explicit PointCut(std::shared_ptr<const PointTree> tree);

  /// Whether nothing within a node's sphere can be seen, because of what has been drawn already.
  using Hidden = std::function<bool(const EncodedNode& node)>;
  /// Finds the front for a view, on several threads. Without `coherent` from the root. Subtrees that are
  /// hidden are left out.
  void update(const CutView& view, bool coherent, const Hidden& hidden = {});

  /// Points are nodes, leaves are those whose triangles are drawn, by rank; depth-first.
  template <class Points, class Leaves>
  void each_list(Points&& points, Leaves&& leaves) const {
    for (const Segment& s : segments_) {
      const Chunk& chunk = chunks_[s.chunk];
      if (!chunk.points.empty()) points(chunk.points);
      if (!chunk.leaves.empty()) leaves(chunk.leaves);
    }
  }
  std::size_t point_count() const { return point_count_; }
  std::size_t leaf_count() const { return leaf_count_; }

  /// Nodes whose bounds the last update looked at.
  std::uint64_t visited() const { return visited_; }
  /// Whether the last update changed what is drawn.
  bool changed() const { return changed_; }
  const PointTree& tree() const { return *tree_; }

 private:
  enum class State : std::uint32_t { culled, point, triangles };
  /// How far the camera may move: by depth, by the distance from the picture's sides, and of the eye.
  struct Slack {
    double depth, side, eye;
  };
  struct Decision {
    bool open;
    State state;  ///< if not open
    Slack slack;
  };
  /// A node of the front. Its motions are those of the chunk at which it must be looked at again.
  struct Entry {
    std::uint32_t node : 30, state : 2;
    float depth, side, eye;
  };
  /// A subtree with a front of its own.
  struct Chunk {
    std::uint64_t root = 0;
    std::vector<Entry> front, next;
    Slack motion{0, 0, 0};  ///< since the front was begun
    bool has_front = false, changed = false;
    std::vector<std::uint32_t> points, leaves;
    std::vector<std::uint32_t> due;  ///< indices into the front
    std::uint64_t visited = 0;
  };
  /// Part of the front in depth-first order: a chunk's, or (in a chunk of its own) a single node above.
  struct Segment {
    std::size_t chunk;
  };
  class Walk;

  void walk_top(std::uint64_t node, const Hidden& hidden, std::vector<std::size_t>& active);
  void add_motion(const CutView& last);
  Decision decide(const EncodedNode& node, bool leaf) const;
  EncodedNode node_at(std::uint64_t index) const {
    if (trusted_nodes_) return trusted_nodes_[index];
    const auto node = tree_->nodes(index, 1);
    return node.empty() ? EncodedNode{} : node[0];
  }

  std::shared_ptr<const PointTree> tree_;
  const EncodedNode* trusted_nodes_ = nullptr;
  std::uint64_t first_chunk_ = 0;  ///< the node of the first chunk; above it are no chunks
  std::vector<Chunk> chunks_;      ///< then one for each node above that is drawn
  std::size_t chunk_count_ = 0;
  std::vector<Segment> segments_, last_segments_;
  CutView view_;
  bool has_view_ = false, changed_ = true;
  std::size_t point_count_ = 0, leaf_count_ = 0;
  std::uint64_t visited_ = 0;
};

}  // namespace dupin

#endif
