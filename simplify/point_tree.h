// A mesh as a tree of bounding spheres with its triangles at the leaves, after Chen & Nguyen, "POP: A Hybrid
// Point and Polygon Rendering System for Large Data", 2001; or, without triangles, with its vertices at the
// leaves, after Rusinkiewicz & Levoy, "QSplat", 2000.
//
// A tree is one block of bytes without pointers. In memory and in a cache file (.dpt) it is the same, so that
// a file is mapped and walked as it lies: what is not looked at is not read. Bytes from a file are not
// believed: the header is checked when it is opened, every page against its checksum when it is first looked
// at, and no reference leads out of the tree.
#ifndef DUPIN_SIMPLIFY_POINT_TREE_H
#define DUPIN_SIMPLIFY_POINT_TREE_H

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../core/progress.h"
#include "../core/status.h"
#include "../nurbs/polygon_mesh.h"
#include "mesh_block.h"
#include "point_node.h"
#include "tree_shape.h"

namespace dupin {

enum class PointTreeKind : std::uint32_t {
  pop,     ///< triangles at the leaves, up to four of them; points above
  qsplat,  ///< vertices at the leaves; also for points without polygons
};

/// What a tree's file says of where it came from.
struct PointTreeSource {
  std::string name;       ///< the part's
  std::string unit_note;  ///< as Model::unit_note
  double scale = 1;       ///< from the part's space to model space
};

struct PointTreeInfo {
  PointTreeKind kind{};
  PointTreeSource source;
  bool colors = false;  ///< nodes and vertices have the file's colours
  std::uint64_t nodes = 0, leaves = 0, triangles = 0;
  PointGrid grid;
  Box3 box;  ///< of the mesh, in its part's space
  /// Half a step: how far a vertex is from where the file has it, in each coordinate.
  double position_error = 0;
};

class PointTree {
 public:
  class Bytes;
  /// `bytes` begin with a header as in a .dpt file.
  static Result<std::shared_ptr<const PointTree>> from_bytes(std::shared_ptr<const Bytes> bytes);
  ~PointTree();

  const PointTreeInfo& info() const { return info_; }
  const TreeShape& shape() const { return shape_; }
  std::size_t byte_count() const;
  /// Without colours where vertices or polygons had some: nodes and vertices have those.
  const std::vector<MeshGroup>& groups() const { return groups_; }

  /// Nodes [first, first + count) of the breadth-first order; empty, once and for all, where their page is
  /// damaged.
  std::span<const EncodedNode> nodes(std::uint64_t first, std::uint64_t count) const;
  /// All of them where their pages need no check, as in a tree that was built here; else null.
  const EncodedNode* trusted_nodes() const;
  /// Each of some nodes; as if all bits were 0 where its page is damaged.
  void copy_nodes(std::span<const std::uint32_t> indices, EncodedNode* nodes) const;
  /// Of an interior node; 0 in a tree that has none.
  std::uint32_t curvature(std::uint64_t node) const;
  /// The group of the leaf with that rank.
  std::uint32_t leaf_group(std::uint64_t rank) const;
  std::uint32_t node_group(std::uint64_t node) const { return leaf_group(shape_.leaves_below(node).first); }

  /// 0 in a tree without triangles.
  std::size_t block_count() const {
    if (info_.kind != PointTreeKind::pop) return 0;
    return static_cast<std::size_t>((info_.leaves + kBlockLeaves - 1) / kBlockLeaves);
  }
  /// The triangles of the leaves with ranks [block · kBlockLeaves, …). False where the file is damaged.
  bool block(std::size_t block, MeshBlock& out) const;
  /// Triangles in the blocks before this one.
  std::uint64_t first_triangle(std::size_t block) const;

  /// What was found damaged since the tree was opened; ok if nothing was.
  Status damage() const;
  /// Looks at every page and block.
  Status verify() const;
  std::span<const char> bytes() const;

 private:
  PointTree() = default;
  Status read_header();
  bool page_is_good(std::uint64_t first, std::uint64_t bytes) const;

  PointTreeInfo info_;
  TreeShape shape_;
  std::vector<MeshGroup> groups_;
  std::shared_ptr<const Bytes> bytes_;
  struct Sections;
  std::unique_ptr<Sections> sections_;
};

struct PointTreeOptions {
  PointTreeKind kind = PointTreeKind::pop;
  PointTreeSource source;
  Progress progress;
};

/// unreadable for a mesh without vertices; a mesh without polygons becomes a qsplat tree of its points. The
/// result does not depend on the number of threads.
Result<std::shared_ptr<const PointTree>> build_point_tree(const PolygonMesh& mesh,
                                                          const PointTreeOptions& options);

/// Writes under a hidden name beside `path` and renames.
Status write_point_tree(const PointTree& tree, const std::string& path);
/// Maps the file.
Result<std::shared_ptr<const PointTree>> open_point_tree(const std::string& path);
/// The tree's triangles again, with their normals, colours and groups; of a tree without triangles its leaves
/// as points. Vertices are where the tree's grid has them. Fails where the tree is damaged.
Result<PolygonMesh> unpack_mesh(const PointTree& tree);
/// Whether these are the first bytes of a .dpt file.
bool is_point_tree(std::span<const char> head);

}  // namespace dupin

#endif
