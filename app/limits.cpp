#include "limits.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>

#include "console.h"
#include "exit_code.h"
#include "output_file.h"

namespace dupin::app {
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(10);
// Work that can be stopped in an orderly way, and the reader with its own limit, get this long beyond the
// limit to do so.
constexpr double kGraceSeconds = 0.5;

[[noreturn]] void end_process(const std::string& why) {
  remove_unfinished_outputs();
  say(why);
  std::fflush(nullptr);
  _exit(kLimitHit);
}

void out_of_memory() {
  end_process("out of memory");
}

std::string megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + 999'999) / 1'000'000) + " MB";
}

std::uint64_t peak_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

std::uint64_t resident_bytes() {
  char text[128] = {};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const auto length = read(file, text, sizeof text - 1);
  close(file);
  unsigned long long total = 0, resident = 0;
  if (length <= 0 || std::sscanf(text, "%llu %llu", &total, &resident) != 2) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_bytes() {
  return peak_of(RUSAGE_SELF);
}
std::uint64_t peak_child_resident_bytes() {
  return peak_of(RUSAGE_CHILDREN);
}

Limits::Limits(double seconds, std::uint64_t bytes) : seconds_(seconds), bytes_(bytes) {
  std::set_new_handler(out_of_memory);
  if (seconds_ > 0 || bytes_ > 0) thread_ = std::thread([this] { watch(); });
}

Limits::~Limits() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

double Limits::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double Limits::seconds_left() const {
  return seconds_ > 0 ? std::max(seconds_ - elapsed(), 1e-3) : 0;
}

void Limits::watch() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kPollInterval, [this] { return stop_; })) {
    if (seconds_ > 0 && elapsed() > seconds_ + kGraceSeconds) {
      char text[64];
      std::snprintf(text, sizeof text, "the time limit of %g s was reached", seconds_);
      end_process(text);
    }
    if (bytes_ > 0 && resident_bytes() > bytes_)
      end_process("the memory limit of " + megabytes(bytes_) + " was reached");
  }
}

}  // namespace dupin::app
