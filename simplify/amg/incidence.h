// Which lists have a number, in one block of memory.
#ifndef DUPIN_SIMPLIFY_AMG_INCIDENCE_H
#define DUPIN_SIMPLIFY_AMG_INCIDENCE_H

#include <cstdint>
#include <span>
#include <vector>

namespace dupin::amg {

class Incidence {
 public:
  /// `list_at(i)` is the i-th of `lists` lists of numbers below `numbers`.
  template <class ListAt>
  Incidence(std::size_t numbers, std::size_t lists, const ListAt& list_at) : starts_(numbers + 1) {
    for (std::size_t i = 0; i < lists; ++i)
      for (const std::uint32_t n : list_at(i)) ++starts_[n + 1];
    for (std::size_t n = 0; n < numbers; ++n) starts_[n + 1] += starts_[n];
    lists_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t i = 0; i < lists; ++i)
      for (const std::uint32_t n : list_at(i)) lists_[next[n]++] = static_cast<std::uint32_t>(i);
  }
  /// Ascending.
  std::span<const std::uint32_t> lists_with(std::size_t number) const {
    return {lists_.data() + starts_[number], lists_.data() + starts_[number + 1]};
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> lists_;
};

}  // namespace dupin::amg

#endif
