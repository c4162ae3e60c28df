#include "seen_numbers.h"

#include <atomic>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr std::size_t kRows = 16;  ///< that one task looks at

}  // namespace

void NumberSet::add(std::uint32_t number) {
  const std::atomic_ref<std::uint64_t> word(words_[number / 64]);
  const std::uint64_t bit = std::uint64_t{1} << number % 64;
  if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
}

void NumberSet::count() {
  before_.resize(words_.size());
  size_ = 0;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    before_[i] = static_cast<std::uint32_t>(size_);
    size_ += static_cast<std::size_t>(std::popcount(words_[i]));
  }
}

void SeenNumbers::collect(SplatRaster& raster, std::size_t point_end, std::size_t triangle_end) {
  points.clear(point_end), triangles.clear(triangle_end);
  constexpr std::uint32_t kTriangle = SplatRaster::kTriangle, kHole = SplatRaster::kHole;
  const auto [first, last] = raster.rows();
  const auto each_pixel = [&, first = first, last = last](auto&& use) {
    if (first >= last) return;
    parallel_for(
        static_cast<std::size_t>(last - first),
        [&](std::size_t row) {
          for (std::uint64_t& pixel : raster.row(first + static_cast<int>(row)))
            if (pixel != 0) use(pixel);
        },
        kRows);
  };
  each_pixel([&](std::uint64_t& pixel) {
    const auto number = ~static_cast<std::uint32_t>(pixel);
    if (number & kTriangle)
      triangles.add(number & (kTriangle - 1));
    else
      points.add(number & (kHole - 1));
  });
  points.count(), triangles.count();
  each_pixel([&](std::uint64_t& pixel) {
    const auto number = ~static_cast<std::uint32_t>(pixel);
    const std::uint32_t renumbered = number & kTriangle
                                         ? kTriangle | triangles.less_than(number & (kTriangle - 1))
                                         : (number & kHole) | points.less_than(number & (kHole - 1));
    pixel = pixel >> 32 << 32 | static_cast<std::uint32_t>(~renumbered);
  });
}

}  // namespace dupin
