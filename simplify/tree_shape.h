// A complete four-way tree in breadth-first order, which needs no pointers: the children of node i are 4i + 1
// … 4i + 4, the interior nodes come first, and leaves have ranks in the order of a depth-first walk.
#ifndef DUPIN_SIMPLIFY_TREE_SHAPE_H
#define DUPIN_SIMPLIFY_TREE_SHAPE_H

#include <algorithm>
#include <cstdint>

namespace dupin {

class TreeShape {
 public:
  TreeShape() = default;
  /// Every interior node has four children, but for the last, which may have two or three.
  explicit TreeShape(std::uint64_t leaves) : leaves_(leaves) {
    if (leaves == 0) return;
    const std::uint64_t last = (leaves - 1) % 3;  // 0: the last interior node is full
    interior_ = (leaves - 1) / 3 + (last > 0);
    nodes_ = interior_ + leaves_;
    while (first_last_ + level_width_ < nodes_) first_last_ += level_width_, level_width_ *= 4;
  }

  std::uint64_t leaves() const { return leaves_; }
  std::uint64_t interior() const { return interior_; }
  std::uint64_t nodes() const { return nodes_; }
  bool is_leaf(std::uint64_t node) const { return node >= interior_; }

  static std::uint64_t first_child(std::uint64_t node) { return 4 * node + 1; }
  static std::uint64_t parent(std::uint64_t node) { return (node - 1) / 4; }
  std::uint64_t child_count(std::uint64_t node) const {
    return is_leaf(node) ? 0 : std::min<std::uint64_t>(4, nodes_ - first_child(node));
  }

  /// Leaves on the last level come first in a depth-first walk: those on the level above it are all to their
  /// right.
  std::uint64_t leaf_rank(std::uint64_t node) const {
    return node >= first_last_ ? node - first_last_ : nodes_ - first_last_ + (node - interior_);
  }
  std::uint64_t leaf_node(std::uint64_t rank) const {
    const std::uint64_t last = nodes_ - first_last_;
    return rank < last ? first_last_ + rank : interior_ + (rank - last);
  }

  /// The ranks [first, last) of the leaves below a node.
  struct Range {
    std::uint64_t first, last;
    std::uint64_t size() const { return last - first; }
  };
  Range leaves_below(std::uint64_t node) const {
    if (is_leaf(node)) return {leaf_rank(node), leaf_rank(node) + 1};
    std::uint64_t lo = node, hi = node;  // its leftmost and rightmost descendants
    while (!is_leaf(lo)) lo = first_child(lo);
    while (!is_leaf(hi)) hi = first_child(hi) + child_count(hi) - 1;
    return {leaf_rank(lo), leaf_rank(hi) + 1};
  }

  static bool is_below(std::uint64_t node, std::uint64_t ancestor) {
    while (node > ancestor) node = parent(node);
    return node == ancestor;
  }

 private:
  std::uint64_t leaves_ = 0, interior_ = 0, nodes_ = 0;
  std::uint64_t first_last_ = 0, level_width_ = 1;  ///< of the last level
};

}  // namespace dupin

#endif
