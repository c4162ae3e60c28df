// Putting a point tree's parts together into its bytes.
#ifndef DUPIN_SIMPLIFY_POINT_TREE_WRITER_H
#define DUPIN_SIMPLIFY_POINT_TREE_WRITER_H

#include <functional>
#include <string>

#include "point_tree.h"

namespace dupin {

struct PointTreeContent {
  PointTreeKind kind{};
  PointTreeSource source;
  bool colors = false;
  PointGrid grid;
  Box3 box;
  std::uint64_t leaves = 0, triangles = 0;
  std::span<const EncodedNode> nodes;
  std::span<const std::uint32_t> curvatures, leaf_groups;
  const std::vector<MeshGroup>* groups = nullptr;
  const std::vector<std::string>* blocks = nullptr;
  std::function<std::uint32_t(std::uint64_t rank)> leaf_triangles;
};

std::string point_tree_bytes(const PointTreeContent& content);

}  // namespace dupin

#endif
