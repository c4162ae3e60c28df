// The triangles of point trees that frames have needed so far, unpacked, in memory and on the GPU.
#ifndef DUPIN_RENDER_MESH_ARENA_H
#define DUPIN_RENDER_MESH_ARENA_H

#include <memory>
#include <vector>

#include "../simplify/point_tree.h"
#include "gl_objects.h"
#include "splat_raster.h"

namespace dupin {

class MeshArena {
 public:
  /// More triangles than this are not kept from frame to frame.
  static constexpr std::size_t kMostKept = 24'000'000;

  MeshArena() = default;
  MeshArena(const Gl& gl, std::vector<std::shared_ptr<const PointTree>> trees);

  /// Of a tree, the leaves (ascending ranks) whose triangles the next frame needs. Call for each, then
  /// load().
  void want(std::size_t tree, std::span<const std::uint32_t> ranks);
  /// Whether with what is wanted it would hold more than kMostKept.
  bool must_make_room() const;
  /// Forgets all triangles: indices given out before no longer hold.
  void make_room();
  /// From 1 on; another after each make_room().
  std::uint64_t generation() const { return generation_; }
  /// Unpacks what is wanted and not there, on several threads, and uploads it. A block that is damaged has no
  /// triangles.
  void load();

  /// Indices into triangles() of a leaf that was wanted: [first, last).
  std::array<std::uint32_t, 2> triangles_of(std::size_t tree, std::uint32_t rank) const {
    const Loaded& block = blocks_[tree][rank / kBlockLeaves];
    const std::size_t leaf = rank % kBlockLeaves;
    if (leaf + 1 >= block.leaf_starts.size()) return {0, 0};
    return {block.first_triangle + block.leaf_starts[leaf],
            block.first_triangle + block.leaf_starts[leaf + 1]};
  }
  const std::vector<SplatVertex>& vertices() const { return vertices_; }
  /// Each with its number in its tree as the fourth word.
  const std::vector<SplatTriangle>& triangles() const { return triangles_; }
  const TexelBuffer& vertex_buffer() const { return vertex_buffer_; }
  const TexelBuffer& triangle_buffer() const { return triangle_buffer_; }

 private:
  struct Loaded {
    bool wanted = false, there = false;
    std::uint32_t first_triangle = 0;
    std::vector<std::uint16_t> leaf_starts;
  };
  struct Place {
    std::size_t tree, block;
  };
  void append(const Place& place, const MeshBlock& block);
  void upload();

  std::vector<std::shared_ptr<const PointTree>> trees_;
  std::vector<std::vector<Loaded>> blocks_;
  std::vector<Place> wanted_;
  std::vector<SplatVertex> vertices_;
  std::vector<SplatTriangle> triangles_;
  std::uint64_t generation_ = 1;
  std::size_t uploaded_vertices_ = 0, uploaded_triangles_ = 0;
  TexelBuffer vertex_buffer_, triangle_buffer_;
};

}  // namespace dupin

#endif
