// Runs the built dupin command as a shell would, in a folder of the test's own.
#ifndef DUPIN_TESTS_APP_COMMAND_H
#define DUPIN_TESTS_APP_COMMAND_H

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace dupin::test {

struct Outcome {
  int exit_code = -1;  ///< 128 + the signal's number where one ended it, as shells have it
  std::string out, err;
  double seconds = 0;
  /// Lines of `err`.
  int error_lines() const;
};

/// `dupin ARGUMENTS…`; standard input is empty. `environment`: what is set besides this process's own.
using Environment = std::vector<std::pair<const char*, const char*>>;
Outcome run_dupin(const std::vector<std::string>& arguments, const Environment& environment = {});

/// An empty folder, removed with all it holds.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& content) const;
  /// What it holds, hidden files included, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path folder_;
};

std::string read_file(const std::string& path);
/// A shipped sample; $DUPIN_DATA's file, or "" where there is none.
std::string sample(const std::string& name);
std::string data_file(const std::string& name);

}  // namespace dupin::test

#endif
