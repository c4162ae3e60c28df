// The triangles of a run of leaves, packed: vertices on the tree's grid and triangles as bits.
//
//   bytes 0 … 3    bits of x, y and z in a vertex; 1 if vertices have colours
//   bytes 4 … 7    numbers of vertices and of triangles
//   bytes 8 … 19   the least x, y and z
//   then bits      each vertex: x, y, z beyond the least, normal (22), red, green and blue (24);
//                  each triangle: how it goes on from its leaf's others, and its new vertices
//
// A leaf's first triangle has three vertices; a further one has a code of 4 bits: 3 j + k, and one vertex, if
// it lies on the other side of edge k of the leaf's triangle j; 15, and three vertices, if not.
#ifndef DUPIN_SIMPLIFY_MESH_BLOCK_H
#define DUPIN_SIMPLIFY_MESH_BLOCK_H

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../nurbs/polygon_mesh.h"

namespace dupin {

inline constexpr std::size_t kBlockLeaves = 128;

/// A corner as it is drawn: on the tree's grid, its normal as in a node.
struct BlockVertex {
  std::array<std::uint32_t, 3> position{};
  std::uint32_t normal = 0;
  Rgba8 color{255, 255, 255, 255};
  friend bool operator==(const BlockVertex&, const BlockVertex&) = default;
};

struct MeshBlock {
  std::vector<BlockVertex> vertices;
  std::vector<std::array<std::uint16_t, 3>> triangles;
  std::vector<std::uint16_t> leaf_starts;  ///< a leaf's first triangle; one more for the end
};

/// Collects the vertices of a block, equal ones once.
class BlockBuilder {
 public:
  explicit BlockBuilder(bool colors) : colors_(colors), table_(2048, kFree) {
    block_.leaf_starts.push_back(0);
  }
  /// A leaf's triangles, in its order or another.
  void add_leaf(std::span<const std::array<BlockVertex, 3>> triangles);
  std::string bytes() const;

 private:
  static constexpr std::uint16_t kFree = 0xffff;
  std::uint16_t vertex(const BlockVertex& v);
  bool colors_;
  MeshBlock block_;
  std::vector<std::uint16_t> table_;
};

/// `leaf_triangles`: how many triangles each leaf of the block has, as its nodes say. False if the bytes do
/// not hold what they promise; nothing outside of them is read, and no index is out of range.
bool decode_block(std::span<const char> bytes, std::span<const std::uint8_t> leaf_triangles, MeshBlock& out);

}  // namespace dupin

#endif
