#include "atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace dupin {
namespace {

Status failure(const std::string& path, const char* what) {
  return {StatusCode::cannot_write, path + ": " + what + " (" + std::strerror(errno) + ")"};
}

bool write_all(int file, const std::vector<char>& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

Status write_directly(const std::string& path, const std::vector<char>& bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return failure(path, "cannot be written");
  const bool written = write_all(file, bytes);
  if (close(file) != 0 || !written) return failure(path, "writing failed");
  return {};
}

}  // namespace

Status write_file(const std::string& path, const std::vector<char>& bytes) {
  struct stat info {};
  const bool exists = stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) return {StatusCode::cannot_write, path + ": is a folder"};
  if (exists && !S_ISREG(info.st_mode)) return write_directly(path, bytes);
  if (exists && access(path.c_str(), W_OK) != 0) return failure(path, "cannot be written");
  std::string temporary = path + ".XXXXXX";
  const int file = mkostemp(temporary.data(), O_CLOEXEC);
  if (file < 0) return failure(path, "cannot be written");
  // mkostemp's files are for their owner alone; give the rights that a new file would have had, or keep the
  // old ones.
  const mode_t mask = umask(0);
  umask(mask);
  const bool written =
      write_all(file, bytes) && fchmod(file, exists ? info.st_mode & 07777 : 0666 & ~mask) == 0;
  const bool closed = close(file) == 0;
  if (written && closed && std::rename(temporary.c_str(), path.c_str()) == 0) return {};
  const Status status = failure(path, "writing failed");
  unlink(temporary.c_str());
  return status;
}

}  // namespace dupin
