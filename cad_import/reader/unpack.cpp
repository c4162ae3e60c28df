#include "unpack.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <memory>
#include <utility>
#include <vector>

#include "../reader_protocol.h"

namespace dupin::reader {

MemoryFile::MemoryFile(MemoryFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

MemoryFile::~MemoryFile() {
  if (fd_ >= 0) ::close(fd_);
}

std::string MemoryFile::path() const {
  return "/proc/self/fd/" + std::to_string(fd_);
}

Result<MemoryFile> unpack_gzip(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(::gzopen(path.c_str(), "rbe"), ::gzclose);
  if (!in) return {StatusCode::unreadable, "the compressed file cannot be opened"};
  const int fd = ::memfd_create("dupin-unpacked", MFD_CLOEXEC);
  if (fd < 0) return {StatusCode::limit, "no memory for unpacking the file"};
  MemoryFile out(fd);
  std::vector<char> buffer(1 << 18);
  std::uint64_t total = 0;
  for (;;) {
    const int n = ::gzread(in.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    if (n < 0) return {StatusCode::unreadable, "the compressed file is damaged"};
    if (n == 0) break;
    total += static_cast<std::uint64_t>(n);
    if (total > kMaxUnpackedBytes)
      return {StatusCode::limit, "the compressed file unpacks to more than 4 GiB"};
    if (!write_all(fd, {buffer.data(), static_cast<std::size_t>(n)}))
      return {StatusCode::limit, "no memory for unpacking the file"};
  }
  // gzread() takes a file that ends too early for complete; gzclose() and gzerror() know better.
  int error = Z_OK;
  ::gzerror(in.get(), &error);
  if (error != Z_OK && error != Z_STREAM_END)
    return {StatusCode::unreadable, "the compressed file is cut off"};
  return out;
}

}  // namespace dupin::reader
