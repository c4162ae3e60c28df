// Which of a picture's points and triangles are seen, and new numbers without gaps for those: of what a frame
// draws, only that has to be gathered and uploaded, and it is no more than the picture has pixels.
#ifndef DUPIN_RENDER_SEEN_NUMBERS_H
#define DUPIN_RENDER_SEEN_NUMBERS_H

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "splat_raster.h"

namespace dupin {

/// A set of numbers. In it they are counted from 0, in their order.
class NumberSet {
 public:
  /// Empty, for numbers below `end`.
  void clear(std::size_t end) { words_.assign((end + 63) / 64, 0); }
  /// From several threads at once.
  void add(std::uint32_t number);
  /// After the last add().
  void count();

  std::size_t size() const { return size_; }
  /// How many are less.
  std::uint32_t less_than(std::size_t number) const {
    const std::size_t word = number / 64;
    if (word >= words_.size()) return static_cast<std::uint32_t>(size_);
    const std::uint64_t below = words_[word] & ((std::uint64_t{1} << number % 64) - 1);
    return before_[word] + static_cast<std::uint32_t>(std::popcount(below));
  }
  /// use(number, how many are less) for each that is in [first, last).
  template <class Use>
  void each(std::size_t first, std::size_t last, Use&& use) const {
    if (first >= last) return;
    std::uint32_t less = less_than(first);
    for (std::size_t word = first / 64; word * 64 < last; ++word) {
      std::uint64_t bits = words_[word];
      if (word == first / 64) bits &= ~std::uint64_t{0} << first % 64;
      if (last - word * 64 < 64) bits &= (std::uint64_t{1} << last % 64) - 1;
      for (; bits != 0; bits &= bits - 1)
        use(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)), less++);
    }
  }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;  ///< how many there are in the words before
  std::size_t size_ = 0;
};

struct SeenNumbers {
  NumberSet points, triangles;
  /// Finds them in a picture whose numbers are below these, and gives its pixels the new numbers.
  void collect(SplatRaster& raster, std::size_t point_end, std::size_t triangle_end);
};

}  // namespace dupin

#endif
