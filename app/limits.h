// Limits of time and memory on the whole command.
#ifndef DUPIN_APP_LIMITS_H
#define DUPIN_APP_LIMITS_H

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace dupin::app {

/// Watches the process from a thread of its own. Work that reports progress is asked to stop when the time is
/// over
/// (`time_is_over`); work that does not, and any that takes more memory than allowed, ends with the process:
/// unfinished outputs are removed, one line says why, the exit code is 5.
class Limits {
 public:
  /// 0: no limit.
  Limits(double seconds, std::uint64_t bytes);
  ~Limits();
  Limits(const Limits&) = delete;
  Limits& operator=(const Limits&) = delete;

  bool time_is_over() const { return seconds_ > 0 && elapsed() >= seconds_; }
  /// What is left of the time; 0 where there is no limit, as ImportOptions has it.
  double seconds_left() const;
  double elapsed() const;
  double seconds() const { return seconds_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void watch();
  double seconds_;
  std::uint64_t bytes_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  std::thread thread_;
};

/// Bytes of this process that are in memory now, and the most that ever were.
std::uint64_t resident_bytes();
std::uint64_t peak_resident_bytes();
/// The most that any finished child of this process had.
std::uint64_t peak_child_resident_bytes();

}  // namespace dupin::app

#endif
