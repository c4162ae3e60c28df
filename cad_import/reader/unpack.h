// Compressed inputs, unpacked in memory with a limit on what comes out.
#ifndef DUPIN_CAD_IMPORT_READER_UNPACK_H
#define DUPIN_CAD_IMPORT_READER_UNPACK_H

#include <cstdint>
#include <string>

#include "../../core/status.h"

namespace dupin::reader {

/// A few kilobytes can unpack to any size; no real CAD file is near this one.
inline constexpr std::uint64_t kMaxUnpackedBytes = 4ull << 30;

/// A file that exists in memory only, has a path to be opened by, and goes with this object.
class MemoryFile {
 public:
  explicit MemoryFile(int fd) : fd_(fd) {}
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&&) = delete;
  ~MemoryFile();
  std::string path() const;

 private:
  int fd_;
};

/// Unpacks a gzip file.
Result<MemoryFile> unpack_gzip(const std::string& path);

}  // namespace dupin::reader

#endif
