// Output files that are there complete or not at all.
#ifndef DUPIN_APP_OUTPUT_FILE_H
#define DUPIN_APP_OUTPUT_FILE_H

#include <string>

#include "../core/status.h"

namespace dupin::app {

/// A file that is written under another name beside its own, and takes its name when it is complete. Until
/// `commit` whatever stood there before stays; without it the destructor leaves nothing behind, and neither
/// does a signal or a limit that ends the process (`remove_unfinished_outputs`).
class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Reserves the output: says before any work is done that a folder is missing or may not be written to.
  Status open(const std::string& path);
  /// Where to write meanwhile; it keeps the extension. A device or pipe is written to directly.
  const std::string& working_path() const { return working_; }
  Status write(const std::string& content);
  Status commit();

 private:
  void forget();
  std::string path_, working_;
  int slot_ = -1;  // in the list that remove_unfinished_outputs goes through
};

/// Safe to call from a signal handler.
void remove_unfinished_outputs();
/// SIGINT, SIGTERM and SIGHUP: removes what is unfinished, then ends the process as the signal would.
void remove_unfinished_outputs_on_signals();

}  // namespace dupin::app

#endif
