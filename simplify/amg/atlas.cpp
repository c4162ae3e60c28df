#include "atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dupin::amg {

bool pack(std::vector<DomainPrimitive>& primitives, std::uint32_t most, DomainAtlas& atlas) {
  std::vector<std::uint32_t> order(primitives.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return primitives[a].height > primitives[b].height;
  });
  double area = 0;
  std::uint32_t widest = 1;
  for (const DomainPrimitive& p : primitives) {
    area += double(p.width) * p.height;
    widest = std::max(widest, p.width);
  }
  if (widest > most || area > double(most) * most) return false;
  const auto width = std::clamp(static_cast<std::uint32_t>(std::ceil(std::sqrt(area) * 1.05)), widest, most);
  std::uint64_t x = 0, y = 0, row = 0;
  for (const std::uint32_t i : order) {
    DomainPrimitive& p = primitives[i];
    if (x + p.width > width) x = 0, y += row, row = 0;
    if (y + p.height > most) return false;
    p.x = static_cast<std::uint32_t>(x);
    p.y = static_cast<std::uint32_t>(y);
    x += p.width;
    row = std::max<std::uint64_t>(row, p.height);
  }
  atlas.width = width;
  atlas.height = static_cast<std::uint32_t>(std::max<std::uint64_t>(1, y + row));
  return true;
}

}  // namespace dupin::amg
