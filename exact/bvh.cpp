#include "bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace dupin::exact {
namespace {

constexpr std::uint32_t kLeafItems = 3;
constexpr double kGrow = 1e-12;  // of the box's coordinates: rounding must lose nothing

Box3 grown(Box3 box) {
  double largest = box.diagonal();
  for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(box.lo[k]), std::abs(box.hi[k])});
  const Vec3 by = Vec3{1, 1, 1} * (kGrow * largest);
  return {box.lo - by, box.hi + by};
}

/// Where the line enters the box, within [least, most]; infinite if it does not.
double entry(const Line& line, const Box3& box, double least, double most) {
  for (int k = 0; k < 3; ++k) {
    const double d = line.direction[k], o = line.origin[k];
    if (d == 0) {
      if (o < box.lo[k] || o > box.hi[k]) return INFINITY;
      continue;
    }
    double a = (box.lo[k] - o) / d, b = (box.hi[k] - o) / d;
    if (a > b) std::swap(a, b);
    least = std::max(least, a);
    most = std::min(most, b);
  }
  return least <= most ? least : INFINITY;
}

}  // namespace

Bvh::Bvh(const std::vector<Box3>& boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0U);
  std::erase_if(items_, [&](std::uint32_t i) { return boxes[i].empty(); });
  if (items_.empty()) return;
  nodes_.push_back({});
  split(0, 0, static_cast<std::uint32_t>(items_.size()), boxes);
  for (const std::uint32_t item : items_) boxes_.push_back(grown(boxes[item]));
}

void Bvh::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                const std::vector<Box3>& boxes) {
  Box3 box, centers;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.add(boxes[items_[i]]);
    centers.add(boxes[items_[i]].center());
  }
  nodes_[node] = {grown(box), first, count};
  if (count <= kLeafItems) return;
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = items_.begin() + first, middle = begin + count / 2, end = begin + count;
  // Ties by index: the same tree every time.
  std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = boxes[a].center()[axis], cb = boxes[b].center()[axis];
    return ca < cb || (ca == cb && a < b);
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {grown(box), children, 0};
  split(children, first, count / 2, boxes);
  split(children + 1, first + count / 2, count - count / 2, boxes);
}

void Bvh::traverse(const Line& line, double least, double most,
                   const std::function<double(std::uint32_t)>& visit) const {
  if (nodes_.empty()) return;
  struct Entry {
    double at;
    std::uint32_t node;
  };
  std::array<Entry, 128> stack;
  std::size_t depth = 0;
  const auto push = [&](std::uint32_t node) {
    const double at = entry(line, nodes_[node].box, least, most);
    if (at < INFINITY) stack[depth++] = {at, node};
  };
  push(0);
  while (depth > 0) {
    const Entry top = stack[--depth];
    if (top.at > most) continue;
    const Node& node = nodes_[top.node];
    if (node.count == 0) {
      push(node.first);
      push(node.first + 1);
      if (depth >= 2 && stack[depth - 1].at > stack[depth - 2].at && stack[depth - 2].node == node.first)
        std::swap(stack[depth - 1], stack[depth - 2]);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (entry(line, boxes_[i], least, most) < INFINITY) most = visit(items_[i]);
  }
}

}  // namespace dupin::exact
