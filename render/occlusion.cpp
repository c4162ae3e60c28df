#include "occlusion.h"

#include <algorithm>
#include <bit>

#include "../core/parallel.h"

namespace dupin {

void Occlusion::begin(int width, int height) {
  width_ = width, height_ = height;
  columns_ = (width + kTile - 1) / kTile, rows_ = (height + kTile - 1) / kTile;
  farthest_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  due_.assign(farthest_.size(), 0);
}

void Occlusion::mark(const PictureExtent& e) {
  for (int row = e.y0 / kTile; row * kTile < e.y1; ++row)
    for (int column = e.x0 / kTile; column * kTile < e.x1; ++column)
      due_[static_cast<std::size_t>(row * columns_ + column)] = 1;
}

void Occlusion::look(int row, int column, const SplatRaster& raster) {
  const int x0 = column * kTile, x1 = std::min(width_, x0 + kTile);
  const int y0 = row * kTile, y1 = std::min(height_, y0 + kTile);
  std::uint64_t least = ~std::uint64_t{0};
  for (int y = y0; y < y1 && least > 0; ++y) {
    const std::uint64_t* const pixels = raster.pixels().data() + static_cast<std::ptrdiff_t>(y) * width_;
    for (int x = x0; x < x1; ++x) least = std::min(least, pixels[x]);
  }
  farthest_[static_cast<std::size_t>(row * columns_ + column)] =
      std::bit_cast<float>(static_cast<std::uint32_t>(least >> 32));
}

void Occlusion::refresh(const SplatRaster& raster) {
  parallel_for(
      static_cast<std::size_t>(rows_),
      [&](std::size_t row) {
        for (std::size_t column = 0; column < static_cast<std::size_t>(columns_); ++column) {
          char& due = due_[row * static_cast<std::size_t>(columns_) + column];
          if (due) look(static_cast<int>(row), static_cast<int>(column), raster);
          due = 0;
        }
      },
      8);
}

bool Occlusion::hides(const PictureExtent& e) const {
  const int x0 = std::max(0, e.x0), y0 = std::max(0, e.y0);
  const int x1 = std::min(width_, e.x1), y1 = std::min(height_, e.y1);
  if (x0 >= x1 || y0 >= y1) return false;
  for (int row = y0 / kTile; row * kTile < y1; ++row)
    for (int column = x0 / kTile; column * kTile < x1; ++column)
      if (!(farthest_[static_cast<std::size_t>(row * columns_ + column)] > e.nearest)) return false;
  return true;
}

}  // namespace dupin
