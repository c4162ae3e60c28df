#include "timed_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace dupin::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr useconds_t kLook = 500;  // microseconds between looks at a process that runs
constexpr int kXvfbMs = 10000;
constexpr int kMostTries = 3;  // another server may take the number that this one was about to have

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> list;
  for (const std::string& word : words) list.push_back(const_cast<char*>(word.c_str()));
  list.push_back(nullptr);
  return list;
}

/// Whether a server listens at display ":N".
bool answers(const std::string& display) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::snprintf(address.sun_path, sizeof address.sun_path, "/tmp/.X11-unix/X%s", display.c_str() + 1);
  const int end = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool there =
      end >= 0 && connect(end, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (end >= 0) close(end);
  return there;
}

/// In the child: a group of its own, so that it can be ended with its children; quiet.
[[noreturn]] void become(const ProcessRun& run, char* const* arguments) {
  setpgid(0, 0);
  for (const auto& [name, value] : run.environment) setenv(name.c_str(), value.c_str(), 1);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nothing, stream);
  execv(arguments[0], arguments);
  _exit(127);
}

/// Waits for the end; false where it had to be ended.
bool wait_for(pid_t child, double seconds, int& status, rusage& usage) {
  const auto start = Clock::now();
  while (wait4(child, &status, WNOHANG, &usage) == 0) {
    if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) {
      kill(-child, SIGKILL);
      wait4(child, &status, 0, &usage);
      return false;
    }
    usleep(kLook);
  }
  return true;
}

std::string why_it_failed(int status, const std::vector<int>& good) {
  if (WIFSIGNALED(status)) return std::string("died: ") + strsignal(WTERMSIG(status));
  const int code = WEXITSTATUS(status);
  return std::count(good.begin(), good.end(), code) ? "" : "exit code " + std::to_string(code);
}

}  // namespace

TimedProcess run_timed(const ProcessRun& run) {
  TimedProcess result;
  const std::vector<char*> arguments = pointers(run.command);
  const auto start = Clock::now();
  const pid_t child = fork();
  if (child < 0) return {0, 0, 0, "no process could be started"};
  if (child == 0) become(run, arguments.data());
  int status = 0;
  rusage usage{};
  const bool ended = wait_for(child, run.seconds, status, usage);
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.processor_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  result.peak_megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
  result.failure = ended ? why_it_failed(status, run.good) : "took too long";
  return result;
}

std::string find_program(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const std::string file = folder + "/" + name; access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

Display::Display() {
  if (const char* display = std::getenv("DISPLAY"); display && *display) {
    name_ = display;
    return;
  }
  for (int i = 0; i < kMostTries && name_.empty(); ++i) {
    stop();
    start();
    if (!name_.empty() && !answers(name_)) name_.clear();
  }
}

void Display::start() {
  const std::string program = find_program({"Xvfb"});
  int ends[2];
  if (program.empty() || pipe(ends) != 0) return;
  const std::string number = std::to_string(ends[1]);
  const std::vector<std::string> words{program, "-displayfd", number, "-screen", "0", "1280x1280x24", "-noreset"};
  const std::vector<char*> arguments = pointers(words);
  server_ = fork();
  if (server_ == 0) {
    close(ends[0]);
    become({}, arguments.data());
  }
  close(ends[1]);
  pollfd wait{ends[0], POLLIN, 0};
  char text[16] = {};
  if (server_ > 0 && poll(&wait, 1, kXvfbMs) == 1 && read(ends[0], text, sizeof text - 1) > 0)
    name_ = ":" + std::to_string(std::atoi(text));
  said_ = ends[0];  // kept open: the server writes the line's end on its own, and dies where nobody can read it
}

void Display::stop() {
  if (said_ >= 0) close(said_);
  said_ = -1;
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
  server_ = -1;
}

Display::~Display() {
  stop();
}

}  // namespace dupin::app
