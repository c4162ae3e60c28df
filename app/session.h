// What every command has in common: its options, limits, progress, and how it talks.
#ifndef DUPIN_APP_SESSION_H
#define DUPIN_APP_SESSION_H

#include <cstdint>
#include <string>

#include "../core/progress.h"
#include "../core/status.h"
#include "console.h"
#include "limits.h"

namespace CLI {
class App;
}

namespace dupin::app {

struct CommonOptions {
  bool quiet = false, verbose = false, no_progress = false, strict = false;
  int threads = 0;                ///< 0: one per core
  double time_limit_seconds = 0;  ///< 0: none
  std::uint64_t memory_limit_bytes = 0;
  std::string units = "mm";  ///< of files that have none
};

void add_common_options(CLI::App& command, CommonOptions& options);

/// One run of one command.
class Session {
 public:
  explicit Session(const CommonOptions& options);

  const CommonOptions& options() const { return options_; }
  const Limits& limits() const { return limits_; }
  /// Draws the bar, and asks the work to stop when the time is over.
  Progress progress();
  /// Always said but with --quiet.
  void warn(const std::string& message);
  /// Said with --verbose only.
  void note(const std::string& message);
  /// Says why, in one line, and returns the exit code.
  int fail(const Status& status);
  /// The bar is taken off the terminal.
  void done() { bar_.clear(); }

 private:
  CommonOptions options_;
  ProgressBar bar_;
  Limits limits_;
};

}  // namespace dupin::app

#endif
