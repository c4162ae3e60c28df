#include <algorithm>

#include "point_tree.h"

namespace dupin {
namespace {

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Vertices of different blocks are not shared.
void add_block(const PointTree& tree, std::size_t index, const MeshBlock& block, PolygonMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const BlockVertex& v : block.vertices) {
    const auto [x, y, z] = v.position;
    mesh.positions.push_back(tree.info().grid.to_part({double(x), double(y), double(z)}));
    mesh.normals.push_back(to_float(decode_normal(v.normal)));
    if (tree.info().colors) mesh.colors.push_back(v.color);
  }
  for (std::size_t leaf = 0; leaf + 1 < block.leaf_starts.size(); ++leaf)
    for (std::size_t t = block.leaf_starts[leaf]; t < block.leaf_starts[leaf + 1]; ++t) {
      for (const std::uint16_t v : block.triangles[t]) mesh.corners.push_back(first + v);
      if (tree.groups().size() > 1)
        mesh.polygon_groups.push_back(tree.leaf_group(index * kBlockLeaves + leaf));
    }
}

void add_points(const PointTree& tree, PolygonMesh& mesh) {
  for (std::uint64_t rank = 0; rank < tree.info().leaves; ++rank) {
    const auto leaf = tree.nodes(tree.shape().leaf_node(rank), 1);
    if (leaf.empty()) return;
    mesh.positions.push_back(tree.info().grid.to_part(node_center(leaf[0])));
    mesh.normals.push_back(to_float(node_normal(leaf[0])));
    if (tree.info().colors) mesh.colors.push_back(decode_color(decode(leaf[0]).color));
  }
}

}  // namespace

Result<PolygonMesh> unpack_mesh(const PointTree& tree) {
  PolygonMesh mesh;
  mesh.groups = tree.groups();
  MeshBlock block;
  for (std::size_t i = 0; i < tree.block_count(); ++i)
    if (tree.block(i, block)) add_block(tree, i, block, mesh);
  if (tree.block_count() == 0) add_points(tree, mesh);
  if (Status status = tree.damage(); !status.ok()) return status;
  return mesh;
}

}  // namespace dupin
