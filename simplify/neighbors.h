// Inside the folder: which points are neighbours before anything is pruned, and which blocks of them can be
// pruned at once.
#ifndef DUPIN_SIMPLIFY_NEIGHBORS_H
#define DUPIN_SIMPLIFY_NEIGHBORS_H

#include <array>
#include <vector>

#include "prune.h"
#include "rectangles.h"

namespace dupin {

/// Points in blocks of a few thousand neighbours: patches, tiles of larger ones, or boxes in space.
struct Blocks {
  std::vector<std::uint32_t> block;                ///< of each point
  std::vector<std::vector<std::uint32_t>> points;  ///< of each block, ascending
};
Blocks make_blocks(const PartPoints& part);

using Pair = std::array<std::uint32_t, 2>;  ///< first < second

/// Whether two points that are near each other may cover the same surface: they overlap, and (exact test)
/// their normals do not turn away from each other.
bool related(const Rectangle& p, const Rectangle& q, const PruneOptions& options);

/// Pairs of related immediate neighbours, each once.
struct NeighborPairs {
  std::vector<std::vector<Pair>> in_grids;  ///< one list a grid
  std::vector<Pair> others;                 ///< between grids, along edges, in space; sorted
};
NeighborPairs neighbor_pairs(const PartPoints& part, const std::vector<Rectangle>& rectangles,
                             const PruneOptions& options);

}  // namespace dupin

#endif
