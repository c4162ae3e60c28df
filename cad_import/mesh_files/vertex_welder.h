// Points that are bit for bit at the same place, as one vertex.
#ifndef DUPIN_CAD_IMPORT_MESH_FILES_VERTEX_WELDER_H
#define DUPIN_CAD_IMPORT_MESH_FILES_VERTEX_WELDER_H

#include <bit>
#include <cstdint>
#include <vector>

#include "../../core/vec.h"

namespace dupin::mesh_files {

class VertexWelder {
 public:
  explicit VertexWelder(std::vector<Vec3>& positions) : positions_(positions), slots_(1024, kFree) {}

  /// The index of the vertex there, a new one if there is none yet.
  std::uint32_t add(Vec3 p) {
    p = {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0 is 0
    if (2 * (positions_.size() + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[find(p)];
    if (slot == kFree) {
      slot = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(p);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;

  static std::uint64_t hash(const Vec3& p) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const double x : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdu;
      h ^= h >> 32;
    }
    return h;
  }
  std::size_t find(const Vec3& p) const {
    std::size_t at = hash(p) & (slots_.size() - 1);
    while (slots_[at] != kFree && !(positions_[slots_[at]] == p)) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t i = 0; i < positions_.size(); ++i) slots_[find(positions_[i])] = i;
  }

  std::vector<Vec3>& positions_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace dupin::mesh_files

#endif
