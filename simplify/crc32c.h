#ifndef DUPIN_SIMPLIFY_CRC32C_H
#define DUPIN_SIMPLIFY_CRC32C_H

#include <cstddef>
#include <cstdint>

namespace dupin {

/// The Castagnoli checksum (RFC 3720), continued from `crc` (0 to begin): finds every change of up to 32
/// neighbouring bits.
std::uint32_t crc32c(const void* data, std::size_t bytes, std::uint32_t crc = 0);

}  // namespace dupin

#endif
