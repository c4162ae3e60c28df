#include "mesh_arena.h"

#include "../core/parallel.h"

namespace dupin {

MeshArena::MeshArena(const Gl& gl, std::vector<std::shared_ptr<const PointTree>> trees)
    : trees_(std::move(trees)), vertex_buffer_(gl, GL_RGBA32UI), triangle_buffer_(gl, GL_RGBA32UI) {
  for (const auto& tree : trees_) blocks_.emplace_back(tree ? tree->block_count() : 0);
  vertex_buffer_.assign(nullptr, 0, GL_DYNAMIC_DRAW);
  triangle_buffer_.assign(nullptr, 0, GL_DYNAMIC_DRAW);
}

void MeshArena::want(std::size_t tree, std::span<const std::uint32_t> ranks) {
  for (const std::uint32_t rank : ranks) {
    Loaded& block = blocks_[tree][rank / kBlockLeaves];
    if (!block.wanted) wanted_.push_back({tree, rank / kBlockLeaves});
    block.wanted = true;
  }
}

bool MeshArena::must_make_room() const {
  std::size_t coming = 0;
  for (const Place& p : wanted_)
    if (!blocks_[p.tree][p.block].there) coming += kMostLeafTriangles * kBlockLeaves;
  return coming > 0 && triangles_.size() + coming > kMostKept && !triangles_.empty();
}

void MeshArena::make_room() {
  vertices_.clear(), triangles_.clear();
  ++generation_;
  uploaded_vertices_ = uploaded_triangles_ = 0;
  for (auto& tree : blocks_)
    for (Loaded& block : tree) block.there = false;
}

void MeshArena::load() {
  std::vector<Place> missing;
  for (const Place& p : wanted_) {
    Loaded& block = blocks_[p.tree][p.block];
    block.wanted = false;
    if (!block.there) missing.push_back(p);
  }
  wanted_.clear();
  // In turns, so that unpacked blocks do not pile up.
  constexpr std::size_t kTurn = 256;
  std::vector<MeshBlock> unpacked(std::min(kTurn, missing.size()));
  for (std::size_t first = 0; first < missing.size(); first += kTurn) {
    const std::size_t count = std::min(kTurn, missing.size() - first);
    parallel_for(count, [&](std::size_t i) {
      const Place& p = missing[first + i];
      if (!trees_[p.tree]->block(p.block, unpacked[i])) unpacked[i] = {};
    });
    for (std::size_t i = 0; i < count; ++i) append(missing[first + i], unpacked[i]);
  }
  upload();
}

void MeshArena::append(const Place& place, const MeshBlock& block) {
  Loaded& loaded = blocks_[place.tree][place.block];
  loaded.there = true;
  loaded.first_triangle = static_cast<std::uint32_t>(triangles_.size());
  loaded.leaf_starts = block.leaf_starts;
  const auto first_vertex = static_cast<std::uint32_t>(vertices_.size());
  for (const BlockVertex& v : block.vertices) {
    const auto [x, y, z] = v.position;
    vertices_.push_back(
        {{x | y << 21, y >> 11 | z << 10},
         v.normal,
         v.color[0] | std::uint32_t{v.color[1]} << 8 | std::uint32_t{v.color[2]} << 16 | 0xff000000U});
  }
  auto number = static_cast<std::uint32_t>(trees_[place.tree]->first_triangle(place.block));
  for (const auto& t : block.triangles)
    triangles_.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2], number++});
}

void MeshArena::upload() {
  const auto bring = [](TexelBuffer& buffer, const auto& list, std::size_t& uploaded) {
    const std::size_t item = sizeof(list[0]);
    if (list.size() == uploaded) return;
    if (list.size() * item > buffer.bytes()) {
      buffer.reserve(list.size() * item, GL_DYNAMIC_DRAW);
      uploaded = 0;
    }
    buffer.write(uploaded * item, list.data() + uploaded, (list.size() - uploaded) * item);
    uploaded = list.size();
  };
  bring(vertex_buffer_, vertices_, uploaded_vertices_);
  bring(triangle_buffer_, triangles_, uploaded_triangles_);
}

}  // namespace dupin
