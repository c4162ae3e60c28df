#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "point_tree_bytes.h"

namespace dupin {
namespace {

class MappedBytes : public PointTree::Bytes {
 public:
  MappedBytes(const char* data, std::size_t size) : data_(data), size_(size) {}
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;
  ~MappedBytes() override { ::munmap(const_cast<char*>(data_), size_); }
  std::span<const char> all() const override { return {data_, size_}; }
  bool trusted() const override { return false; }

 private:
  const char* data_;
  std::size_t size_;
};

Status system_failure(StatusCode code, const std::string& path) {
  return {code, path + ": " + std::strerror(errno)};
}

}  // namespace

Status write_point_tree(const PointTree& tree, const std::string& path) {
  const std::filesystem::path target(path);
  std::string hidden_name(1, '.');
  hidden_name.append(target.filename().string()).append(".").append(std::to_string(::getpid()));
  const std::string hidden = (target.parent_path() / hidden_name).string();
  std::FILE* const file = std::fopen(hidden.c_str(), "wbe");
  if (!file) return system_failure(StatusCode::cannot_write, path);
  const std::span<const char> bytes = tree.bytes();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool closed = std::fclose(file) == 0;
  if (written && closed && std::rename(hidden.c_str(), path.c_str()) == 0) return {};
  const Status status = system_failure(StatusCode::cannot_write, path);
  std::remove(hidden.c_str());
  return status;
}

Result<std::shared_ptr<const PointTree>> open_point_tree(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return system_failure(StatusCode::unreadable, path);
  struct stat info {};
  void* at = MAP_FAILED;
  const bool regular = ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
  if (regular && info.st_size > 0)
    at = ::mmap(nullptr, static_cast<std::size_t>(info.st_size), PROT_READ, MAP_PRIVATE, fd, 0);
  const Status failed = system_failure(StatusCode::unreadable, path);
  ::close(fd);
  if (!regular) return {StatusCode::unreadable, path + ": is not a regular file"};
  if (info.st_size == 0) return {StatusCode::unreadable, path + ": the file is empty"};
  if (at == MAP_FAILED) return failed;
  auto bytes =
      std::make_shared<MappedBytes>(static_cast<const char*>(at), static_cast<std::size_t>(info.st_size));
  Result<std::shared_ptr<const PointTree>> tree = PointTree::from_bytes(std::move(bytes));
  if (!tree.ok()) return {tree.status().code, path + ": " + tree.status().message};
  return tree;
}

}  // namespace dupin
