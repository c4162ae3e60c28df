// Sparse matrices, row by row. T is double, or anything with + and with products by a double.
#ifndef DUPIN_SIMPLIFY_AMG_SPARSE_H
#define DUPIN_SIMPLIFY_AMG_SPARSE_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "../../core/parallel.h"

namespace dupin::amg {

/// Row i has the entries starts[i] … starts[i + 1].
template <class T>
struct Sparse {
  std::uint32_t columns = 0;
  std::vector<std::uint64_t> starts{0};
  std::vector<std::uint32_t> column;
  std::vector<T> value;

  std::uint32_t rows() const { return static_cast<std::uint32_t>(starts.size() - 1); }
  void add(std::uint32_t j, const T& v) {
    column.push_back(j);
    value.push_back(v);
  }
  void end_row() { starts.push_back(column.size()); }
  std::span<const std::uint32_t> columns_of(std::uint32_t row) const {
    return {column.data() + starts[row], column.data() + starts[row + 1]};
  }
  std::span<const T> values_of(std::uint32_t row) const {
    return {value.data() + starts[row], value.data() + starts[row + 1]};
  }
};

template <class T>
Sparse<T> transposed(const Sparse<T>& m) {
  Sparse<T> t;
  t.columns = m.rows();
  t.starts.assign(m.columns + std::size_t{1}, 0);
  for (const std::uint32_t j : m.column) ++t.starts[j + 1];
  for (std::size_t j = 0; j < m.columns; ++j) t.starts[j + 1] += t.starts[j];
  t.column.resize(m.column.size());
  t.value.resize(m.value.size());
  std::vector<std::uint64_t> next(t.starts.begin(), t.starts.end() - 1);
  for (std::uint32_t i = 0; i < m.rows(); ++i)
    for (std::uint64_t k = m.starts[i]; k < m.starts[i + 1]; ++k) {
      const std::uint64_t at = next[m.column[k]]++;
      t.column[at] = i;
      t.value[at] = m.value[k];
    }
  return t;
}

/// The rows of all parts, one after the other.
template <class T>
Sparse<T> joined(const std::vector<Sparse<T>>& parts, std::uint32_t columns) {
  Sparse<T> result;
  result.columns = columns;
  std::size_t entries = 0, rows = 0;
  for (const auto& part : parts) entries += part.column.size(), rows += part.rows();
  result.starts.reserve(rows + 1);
  result.column.reserve(entries);
  result.value.reserve(entries);
  for (const auto& part : parts) {
    const std::uint64_t before = result.column.size();
    for (std::size_t k = 1; k < part.starts.size(); ++k) result.starts.push_back(before + part.starts[k]);
    result.column.insert(result.column.end(), part.column.begin(), part.column.end());
    result.value.insert(result.value.end(), part.value.begin(), part.value.end());
  }
  return result;
}

/// a b, by Gustavson: each row's columns come in the order in which they are met first.
template <class A, class B>
auto product(const Sparse<A>& a, const Sparse<B>& b) {
  using T = decltype(A{} * B{});
  // Each chunk pays for a table as long as b is wide, so there are few; rows do not depend on it.
  const std::uint32_t chunk_rows =
      std::max(2048U, a.rows() / static_cast<std::uint32_t>(2 * thread_limit()) + 1);
  const std::uint32_t chunks = (a.rows() + chunk_rows - 1) / chunk_rows;
  std::vector<Sparse<T>> parts(chunks);
  parallel_for(chunks, [&](std::size_t c) {
    Sparse<T>& part = parts[c];
    std::vector<std::uint64_t> place(b.columns, std::numeric_limits<std::uint64_t>::max());
    const auto first = static_cast<std::uint32_t>(c) * chunk_rows;
    for (std::uint32_t i = first; i < std::min(a.rows(), first + chunk_rows); ++i) {
      const std::uint64_t row = part.column.size();
      for (std::uint64_t k = a.starts[i]; k < a.starts[i + 1]; ++k)
        for (std::uint64_t q = b.starts[a.column[k]]; q < b.starts[a.column[k] + 1]; ++q) {
          const std::uint32_t j = b.column[q];
          const T v = a.value[k] * b.value[q];
          const std::uint64_t at = place[j];
          if (at < part.column.size() && at >= row) {
            part.value[at] += v;
          } else {
            place[j] = part.column.size();
            part.add(j, v);
          }
        }
      part.end_row();
    }
  });
  return joined(parts, b.columns);
}

/// pᵀ m p
template <class T>
Sparse<T> coarse(const Sparse<T>& m, const Sparse<double>& p) {
  return product(transposed(p), product(m, p));
}

}  // namespace dupin::amg

#endif
