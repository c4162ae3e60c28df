// What goes between Multigrid and dupin-multigrid, over a socket that is the program's descriptor 3: a header
// and three arrays, in this machine's own representation, once in each direction for each matrix.
#ifndef DUPIN_SIMPLIFY_AMG_MULTIGRID_PROTOCOL_H
#define DUPIN_SIMPLIFY_AMG_MULTIGRID_PROTOCOL_H

#include <cstdint>

namespace dupin::amg {

inline constexpr int kMultigridSocket = 3;
inline constexpr std::uint32_t kMultigridMagic = 0x31474d41;  // "AMG1"

/// Then: rows + 1 starts (int32), entries columns (int32), entries values (double). hypre's own integers have
/// 32 bits.
struct MatrixHeader {
  std::uint32_t magic = kMultigridMagic;
  std::uint32_t rows = 0, columns = 0, entries = 0;
};
inline constexpr std::uint64_t kMostEntries = (1U << 31) - 1;

}  // namespace dupin::amg

#endif
