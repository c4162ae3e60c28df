#include "report_run.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>

extern char** environ;

namespace dupin::app {
namespace {

namespace fs = std::filesystem;

/// What the program says on standard error, up to its first line's end.
std::string first_line(int pipe) {
  std::string text;
  std::array<char, 512> buffer{};
  for (ssize_t n; (n = read(pipe, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(n));
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::string make_report(const std::string& folder) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path() / "dupin-report";
  if (!fs::exists(program, error)) return program.string() + " is not there";
  int ends[2];
  if (pipe(ends) != 0) return std::strerror(errno);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  std::string name = program.string(), argument = folder;
  char* arguments[] = {name.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawn(&child, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string said = failed ? std::strerror(failed) : first_line(ends[0]);
  close(ends[0]);
  if (failed) return said;
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return said.empty() ? "dupin-report failed" : said;
}

}  // namespace dupin::app
