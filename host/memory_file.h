// A file in memory, which other processes of the same user can open by its path (Linux).
#ifndef DUPIN_HOST_MEMORY_FILE_H
#define DUPIN_HOST_MEMORY_FILE_H

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <string>

namespace dupin {

class MemoryFile {
 public:
  MemoryFile(const void* bytes, std::size_t size) : descriptor_(::memfd_create("dupin", MFD_CLOEXEC)) {
    const char* at = static_cast<const char*>(bytes);
    while (descriptor_ >= 0 && size > 0) {
      const ssize_t written = ::write(descriptor_, at, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return;
      at += written, size -= static_cast<std::size_t>(written);
    }
    whole_ = descriptor_ >= 0;
  }
  ~MemoryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  /// Whether all bytes are in it.
  bool whole() const { return whole_; }
  std::string path() const {
    return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
  bool whole_ = false;
};

}  // namespace dupin

#endif
