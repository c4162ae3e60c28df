// Which leaf goes where in a point tree: near ones together.
#ifndef DUPIN_SIMPLIFY_TREE_ORDER_H
#define DUPIN_SIMPLIFY_TREE_ORDER_H

#include <cstdint>
#include <vector>

#include "../core/vec.h"
#include "tree_shape.h"

namespace dupin {

/// For each rank of the shape the index of its leaf: every node's leaves are split along the longest axis of
/// their centres, and both halves again. The same whatever the number of threads.
std::vector<std::uint32_t> tree_order(const TreeShape& shape, const std::vector<Vec3>& centers);

}  // namespace dupin

#endif
