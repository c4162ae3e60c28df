#include "output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace dupin::app {
namespace {

constexpr int kMaxOutputs = 8;
// Plain memory, so that a signal handler can read it: the working paths of outputs that are not complete.
std::array<std::atomic<char*>, kMaxOutputs> unfinished{};

Status cannot_write(const std::string& path, int error) {
  return {StatusCode::cannot_write, path + ": cannot write: " + std::strerror(error)};
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

std::string working_name(const std::string& path) {
  const std::string folder = folder_of(path), name = path.substr(folder.size());
  const auto dot = name.rfind('.');
  const std::string extension = dot == std::string::npos ? "" : name.substr(dot);
  return folder + "." + name + ".part-" + std::to_string(getpid()) + extension;
}

void on_signal(int number) {
  remove_unfinished_outputs();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void remove_unfinished_outputs() {
  for (auto& path : unfinished)
    if (char* name = path.load()) unlink(name);
}

void remove_unfinished_outputs_on_signals() {
  for (int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
}

Status OutputFile::open(const std::string& path) {
  path_ = path;
  struct stat info;
  if (stat(path.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode)) return cannot_write(path, EISDIR);
    if (!S_ISREG(info.st_mode)) {
      working_ = path;
      return {};
    }
    if (access(path.c_str(), W_OK) != 0) return cannot_write(path, errno);
  }
  working_ = working_name(path);
  const int file = ::open(working_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0) return cannot_write(path, errno);
  close(file);
  for (int i = 0; i < kMaxOutputs && slot_ < 0; ++i) {
    char* none = nullptr;
    char* name = strdup(working_.c_str());
    if (unfinished[i].compare_exchange_strong(none, name))
      slot_ = i;
    else
      std::free(name);
  }
  return {};
}

Status OutputFile::write(const std::string& content) {
  std::FILE* file = std::fopen(working_.c_str(), "wb");
  if (!file) return cannot_write(path_, errno);
  const bool wrote = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const int error = errno;
  if (std::fclose(file) != 0 || !wrote) return cannot_write(path_, wrote ? errno : error);
  return {};
}

Status OutputFile::commit() {
  if (slot_ >= 0 && std::rename(working_.c_str(), path_.c_str()) != 0) return cannot_write(path_, errno);
  forget();
  return {};
}

void OutputFile::forget() {
  if (slot_ >= 0) std::free(unfinished[slot_].exchange(nullptr));
  slot_ = -1;
}

OutputFile::~OutputFile() {
  if (slot_ >= 0) unlink(working_.c_str());
  forget();
}

}  // namespace dupin::app
