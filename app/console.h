// What the command tells a person: on standard error, a line each.
#ifndef DUPIN_APP_CONSOLE_H
#define DUPIN_APP_CONSOLE_H

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "../core/status.h"

namespace dupin::app {

/// A bar on one line of the terminal, gone again when the work is done. Calls may come from any thread.
class ProgressBar {
 public:
  /// Draws only if standard error is a terminal.
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }
  void show(std::string_view stage, double fraction);
  void clear();

 private:
  std::mutex mutex_;
  bool enabled_, drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// "dupin: MESSAGE", in one line whatever the message holds.
void say(const std::string& message);
/// The same for a failure; returns its exit code.
int fail(const Status& status);

}  // namespace dupin::app

#endif
