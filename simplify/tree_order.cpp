#include "tree_order.h"

#include <algorithm>
#include <array>

#include "../core/parallel.h"

namespace dupin {
namespace {

struct Item {
  std::array<float, 3> center;
  std::uint32_t index;
};

struct Work {
  std::uint64_t node, first, last;  ///< its leaves: ranks, and where they lie in the list
};

class Splitter {
 public:
  Splitter(const TreeShape& shape, const std::vector<Vec3>& centers) : shape_(shape), items_(centers.size()) {
    const Vec3 origin = centers.empty() ? Vec3{} : centers[0];
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const Vec3 c = centers[i] - origin;
      items_[i] = {{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
                   static_cast<std::uint32_t>(i)};
    }
  }

  std::vector<std::uint32_t> run() {
    std::vector<Work> level{{0, 0, items_.size()}};
    while (!level.empty() && level.size() < kTasks) {
      std::vector<std::vector<Work>> below(level.size());
      parallel_for(level.size(), [&](std::size_t i) { below[i] = split(level[i]); });
      level.clear();
      for (const auto& part : below) level.insert(level.end(), part.begin(), part.end());
    }
    parallel_for(level.size(), [&](std::size_t i) { split_all(level[i]); });
    std::vector<std::uint32_t> order(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) order[i] = items_[i].index;
    return order;
  }

 private:
  static constexpr std::size_t kTasks = 256;

  void split_all(const Work& work) {
    for (const Work& child : split(work)) split_all(child);
  }

  /// Sorts a node's leaves to its children, and returns these.
  std::vector<Work> split(const Work& work) {
    const std::uint64_t count = shape_.child_count(work.node), child = TreeShape::first_child(work.node);
    if (count == 0) return {};
    std::array<std::uint64_t, 5> ends{work.first};
    for (std::uint64_t k = 0; k < count; ++k) ends[k + 1] = ends[k] + shape_.leaves_below(child + k).size();
    if (count == 4) {
      halve(work.first, ends[2], work.last);
      halve(work.first, ends[1], ends[2]);
      halve(ends[2], ends[3], work.last);
    } else {
      halve(work.first, ends[1], work.last);
      if (count == 3) halve(ends[1], ends[2], work.last);
    }
    std::vector<Work> children;
    for (std::uint64_t k = 0; k < count; ++k) children.push_back({child + k, ends[k], ends[k + 1]});
    return children;
  }

  void halve(std::uint64_t first, std::uint64_t middle, std::uint64_t last) {
    if (first == middle || middle == last) return;
    const auto at = [this](std::uint64_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::array<float, 3> lo = items_[first].center, hi = lo;
    for (auto i = at(first); i != at(last); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        lo[k] = std::min(lo[k], i->center[k]), hi[k] = std::max(hi[k], i->center[k]);
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
    // Equal coordinates are told apart, so that the result does not depend on the algorithm.
    std::nth_element(at(first), at(middle), at(last), [axis](const Item& a, const Item& b) {
      return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.index < b.index;
    });
  }

  const TreeShape& shape_;
  std::vector<Item> items_;
};

}  // namespace

std::vector<std::uint32_t> tree_order(const TreeShape& shape, const std::vector<Vec3>& centers) {
  return Splitter(shape, centers).run();
}

}  // namespace dupin
