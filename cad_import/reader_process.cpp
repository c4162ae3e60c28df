#include "reader_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "reader_protocol.h"

extern char** environ;

namespace dupin {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollMilliseconds = 50;
constexpr double kExitGraceSeconds = 2;  // between the end of the answer and the end of the process
constexpr std::size_t kKeptErrorBytes = 4096;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  int get() const { return fd_; }
  bool open() const { return fd_ >= 0; }

 private:
  int fd_;
};

struct Pipe {
  Descriptor read, write;
};

std::optional<Pipe> make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  // A descriptor that already has the number it shall get in the child would keep its close-on-exec mark.
  for (int& end : ends)
    if (end <= kReaderPipe) {
      const int moved = ::fcntl(end, F_DUPFD_CLOEXEC, 16);
      ::close(end);
      if (moved < 0) return std::nullopt;
      end = moved;
    }
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

std::string signal_name(int number) {
  const char* name = ::sigabbrev_np(number);
  return name ? std::string("SIG") + name : "signal " + std::to_string(number);
}

std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
    text.remove_suffix(1);
  const std::size_t start = text.find_last_of('\n');
  std::string line(start == text.npos ? text : text.substr(start + 1));
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  return line.substr(0, 200);
}

class Watch {
 public:
  explicit Watch(const ReaderCommand& command) : command_(command) {}
  ~Watch() { kill_and_reap(); }

  Result<std::string> run() {
    if (Status started = start(); !started.ok()) return started;
    while (answer_.open()) {
      if (Status going_on = step(); !going_on.ok()) return going_on;
      if (complete_) break;
    }
    return finish();
  }

 private:
  Status start() {
    auto answer = make_pipe(), errors = make_pipe();
    if (!answer || !errors) return failure(StatusCode::limit, "no pipe could be made for the CAD reader");
    std::vector<char*> argv{const_cast<char*>(command_.executable.c_str())};
    for (const std::string& a : command_.arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors->write.get(), 1);
    posix_spawn_file_actions_adddup2(&actions, errors->write.get(), 2);
    posix_spawn_file_actions_adddup2(&actions, answer->write.get(), kReaderPipe);
    posix_spawn_file_actions_addclosefrom_np(&actions, kReaderPipe + 1);
    // A host may block or ignore signals; the reader must die of its own crashes.
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    pid_t child = -1;
    const int error =
        ::posix_spawn(&child, command_.executable.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
      return {StatusCode::unreadable,
              "the CAD reader " + command_.executable + " cannot be started: " + std::strerror(error)};
    child_ = child;
    start_ = Clock::now();
    answer_ = std::move(answer->read);
    errors_ = std::move(errors->read);
    return {};
  }

  Status step() {
    pollfd fds[2] = {{answer_.get(), POLLIN, 0}, {errors_.get(), POLLIN, 0}};
    ::poll(fds, errors_.open() ? 2 : 1, kPollMilliseconds);
    if (errors_.open() && fds[1].revents) drain_errors();
    if (fds[0].revents)
      if (Status read = drain_answer(); !read.ok()) return read;
    if (command_.time_limit_seconds > 0 && seconds_since(start_) > command_.time_limit_seconds)
      return failure(StatusCode::limit, "reading took longer than the time limit of " +
                                            seconds_text(command_.time_limit_seconds) + in_stage());
    return report_stage();
  }

  // Also without news, so that the caller can stop a reader that has none.
  Status report_stage() const {
    if (report(command_.progress, stage_, fraction_)) return {};
    return failure(StatusCode::cancelled, "reading was stopped");
  }

  void drain_errors() {
    char buffer[4096];
    for (;;) {
      const ssize_t n = ::read(errors_.get(), buffer, sizeof buffer);
      if (n < 0 && errno == EINTR) continue;
      if (n == 0 || (n < 0 && errno != EAGAIN)) errors_.close();
      if (n <= 0) return;
      error_text_.append(buffer, static_cast<std::size_t>(n));
      if (error_text_.size() > 2 * kKeptErrorBytes)
        error_text_.erase(0, error_text_.size() - kKeptErrorBytes);
    }
  }

  Status drain_answer() {
    char buffer[65536];
    for (int turns = 0; turns < 256; ++turns) {
      const ssize_t n = ::read(answer_.get(), buffer, sizeof buffer);
      if (n < 0 && errno == EINTR) continue;
      if (n == 0 || (n < 0 && errno != EAGAIN)) answer_.close();
      if (n <= 0) return {};
      received_.append(buffer, static_cast<std::size_t>(n));
      if (received_.size() > command_.answer_limit_bytes)
        return failure(StatusCode::limit, "the CAD reader's answer is too large");
      if (Status frames = take_frames(); !frames.ok()) return frames;
    }
    return {};
  }

  // Takes the small frames off `received_`; leaves the model's payload there until all of it has come.
  Status take_frames() {
    while (!complete_ && received_.size() - taken_ >= sizeof(FrameHeader)) {
      FrameHeader header;
      std::memcpy(&header, received_.data() + taken_, sizeof header);
      const bool small = header.kind == FrameKind::stage || header.kind == FrameKind::failure;
      if (header.magic != kFrameMagic || !(small || header.kind == FrameKind::model) ||
          header.length > (small ? kMaxTextFrameBytes : command_.answer_limit_bytes))
        return failure(StatusCode::unreadable, "the CAD reader answered with garbage");
      if (received_.size() - taken_ - sizeof header < header.length) return {};
      const std::string_view payload(received_.data() + taken_ + sizeof header, header.length);
      if (Status taken = take_frame(header.kind, payload); !taken.ok()) return taken;
      if (!complete_) taken_ += sizeof header + header.length;
    }
    return {};
  }

  Status take_frame(FrameKind kind, std::string_view payload) {
    if (kind == FrameKind::model) {
      complete_ = true;
      return {};
    }
    if (kind == FrameKind::stage && payload.size() >= sizeof(double)) {
      std::memcpy(&fraction_, payload.data(), sizeof fraction_);
      if (!(fraction_ >= 0 && fraction_ <= 1)) fraction_ = 0;
      stage_ = last_line(payload.substr(sizeof(double)));
      return report_stage();
    }
    std::uint32_t code = 0;
    if (kind == FrameKind::failure && payload.size() >= sizeof code) {
      std::memcpy(&code, payload.data(), sizeof code);
      const bool limit = code == static_cast<std::uint32_t>(StatusCode::limit);
      const bool argument = code == static_cast<std::uint32_t>(StatusCode::invalid_argument);
      return failure(limit      ? StatusCode::limit
                     : argument ? StatusCode::invalid_argument
                                : StatusCode::unreadable,
                     last_line(payload.substr(sizeof code)));
    }
    return failure(StatusCode::unreadable, "the CAD reader answered with garbage");
  }

  Result<std::string> finish() {
    if (complete_) {
      received_.erase(0, taken_ + sizeof(FrameHeader));
      return std::move(received_);
    }
    return explain_death();
  }

  Status explain_death() {
    int status = 0;
    const Clock::time_point closed = Clock::now();
    while (reap(WNOHANG, status) == 0 && seconds_since(closed) < kExitGraceSeconds)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (errors_.open()) drain_errors();
    if (child_ > 0)
      return failure(StatusCode::unreadable, "the CAD reader closed its answer and hung" + in_stage());
    if (reaped_ && WIFSIGNALED(status)) {
      if (WTERMSIG(status) == SIGXCPU)
        return failure(StatusCode::limit, "reading took longer than the time limit" + in_stage());
      return failure(StatusCode::unreadable,
                     "the CAD reader crashed (" + signal_name(WTERMSIG(status)) + ")" + in_stage());
    }
    std::string message = "the CAD reader ended without an answer";
    if (reaped_ && WIFEXITED(status) && WEXITSTATUS(status) != 0)
      message += " (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
    const std::string said = last_line(error_text_);
    return failure(StatusCode::unreadable, message + in_stage() + (said.empty() ? "" : ": " + said));
  }

  // 0: still running. Sets child_ to -1 once it is gone (or somebody else, a SIGCHLD handler, has reaped it).
  int reap(int flags, int& status) {
    if (child_ <= 0) return -1;
    pid_t done;
    do done = ::waitpid(child_, &status, flags);
    while (done < 0 && errno == EINTR);
    if (done == 0) return 0;
    reaped_ = done == child_;
    child_ = -1;
    return 1;
  }

  void kill_and_reap() {
    if (child_ <= 0) return;
    ::kill(-child_, SIGKILL);
    int status;
    reap(0, status);
  }

  Status failure(StatusCode code, std::string message) const {
    return {code, command_.subject + ": " + std::move(message)};
  }
  std::string in_stage() const { return stage_.empty() ? "" : " (" + stage_ + ")"; }
  static std::string seconds_text(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%g s", seconds);
    return text;
  }

  const ReaderCommand& command_;
  pid_t child_ = -1;
  bool reaped_ = false, complete_ = false;
  Clock::time_point start_;
  Descriptor answer_, errors_;
  std::string received_, error_text_, stage_ = "starting";
  std::size_t taken_ = 0;
  double fraction_ = 0;
};

bool is_program(const std::string& path) {
  return !path.empty() && ::access(path.c_str(), X_OK) == 0;
}

/// Where the program lies, and the file that this code is in: a host's plug-in or library.
std::vector<std::filesystem::path> own_folders() {
  std::error_code error;
  std::vector<std::filesystem::path> folders{
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path()};
  Dl_info info;
  if (::dladdr(reinterpret_cast<const void*>(&find_reader), &info) && info.dli_fname)
    folders.push_back(std::filesystem::canonical(info.dli_fname, error).parent_path());
  return folders;
}

}  // namespace

Result<std::string> run_reader(const ReaderCommand& command) {
  return Watch(command).run();
}

Result<std::string> find_reader(const std::string& asked) {
  const char* from_environment = std::getenv("DUPIN_READER");
  for (const std::string& named : {asked, std::string(from_environment ? from_environment : "")}) {
    if (named.empty()) continue;
    if (is_program(named)) return named;
    return {StatusCode::unreadable, "the CAD reader " + named + " is missing or cannot be run"};
  }
  for (const std::filesystem::path& self : own_folders())
    for (const char* place :
         {"dupin-reader", "../libexec/dupin/dupin-reader", "../cad_import/dupin-reader",
          "../../libexec/dupin/dupin-reader", "../../cad_import/dupin-reader"})  // a build tree's
      if (is_program(self / place)) return (self / place).lexically_normal().string();
  if (is_program(DUPIN_INSTALLED_READER)) return std::string(DUPIN_INSTALLED_READER);
  return {StatusCode::unreadable,
          "the CAD reader (dupin-reader) was not found; set DUPIN_READER or install it "
          "to " DUPIN_INSTALLED_READER};
}

}  // namespace dupin
