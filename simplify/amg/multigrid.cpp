#include "multigrid.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "multigrid_protocol.h"

extern char** environ;

namespace dupin::amg {
namespace {

constexpr int kPollMilliseconds = 50;

bool is_program(const std::string& path) {
  return !path.empty() && ::access(path.c_str(), X_OK) == 0;
}

/// $DUPIN_MULTIGRID, then beside the running program, then in ../libexec/dupin from there, then in a build
/// tree, then where the library was installed to.
Result<std::string> find_program() {
  if (const char* named = std::getenv("DUPIN_MULTIGRID"); named && *named) {
    if (is_program(named)) return std::string(named);
    return {StatusCode::unreadable,
            std::string("the multigrid program ") + named + " is missing or cannot be run"};
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const std::filesystem::path& place :
       {self / "dupin-multigrid", self / "../libexec/dupin/dupin-multigrid",
        self / "../simplify/dupin-multigrid", self / "../../simplify/dupin-multigrid",
        std::filesystem::path(DUPIN_INSTALLED_MULTIGRID)})
    if (is_program(place)) return place.lexically_normal().string();
  return {
      StatusCode::unreadable,
      "decomposing surfaces into domains needs dupin-multigrid, which was not found: Dupin was built without "
      "hypre (libhypre-dev), or set DUPIN_MULTIGRID"};
}

Status failure(const char* why) {
  return {StatusCode::unreadable, std::string("dupin-multigrid ") + why};
}

}  // namespace

class Multigrid::Process {
 public:
  ~Process() {
    if (socket_ >= 0) ::close(socket_);
    if (child_ <= 0) return;
    // It ends by itself when the socket closes, unless it is in the middle of something.
    ::kill(child_, SIGKILL);
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  Status start(const std::string& program) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      return {StatusCode::limit, "no socket could be made for dupin-multigrid"};
    socket_ = ends[0];
    // A descriptor that already has the number it shall get in the child would keep its close-on-exec mark.
    const int theirs = ::fcntl(ends[1], F_DUPFD_CLOEXEC, 16);
    ::close(ends[1]);
    if (theirs < 0) return {StatusCode::limit, "no socket could be made for dupin-multigrid"};
    const Status spawned = spawn(program, theirs);
    ::close(theirs);
    return spawned;
  }

  Status send(const void* from, std::size_t bytes, const Progress& progress) {
    for (auto* at = static_cast<const char*>(from); bytes > 0;) {
      if (Status ready = wait_for(POLLOUT, progress); !ready.ok()) return ready;
      const ssize_t n = ::send(socket_, at, bytes, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (n <= 0) return failure("ended before it had the matrix");
      at += n;
      bytes -= static_cast<std::size_t>(n);
    }
    return {};
  }

  Status receive(void* to, std::size_t bytes, const Progress& progress) {
    for (auto* at = static_cast<char*>(to); bytes > 0;) {
      if (Status ready = wait_for(POLLIN, progress); !ready.ok()) return ready;
      const ssize_t n = ::recv(socket_, at, bytes, MSG_DONTWAIT);
      if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (n <= 0) return failure("ended without an answer");
      at += n;
      bytes -= static_cast<std::size_t>(n);
    }
    return {};
  }

 private:
  Status spawn(const std::string& program, int socket) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, socket, kMultigridSocket);
    posix_spawn_file_actions_addclosefrom_np(&actions, kMultigridSocket + 1);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    char* argv[] = {const_cast<char*>(program.c_str()), nullptr};
    const int error = ::posix_spawn(&child_, program.c_str(), &actions, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error == 0) return {};
    child_ = -1;
    return {StatusCode::unreadable, program + " cannot be started: " + std::strerror(error)};
  }

  Status wait_for(short events, const Progress& progress) {
    pollfd fd{socket_, events, 0};
    while (::poll(&fd, 1, kPollMilliseconds) == 0)
      if (!report(progress, "multigrid", 0)) return {StatusCode::cancelled, ""};
    return {};
  }

  pid_t child_ = -1;
  int socket_ = -1;
};

namespace {

/// Every index and number of it, so that whatever goes wrong over there goes no further.
bool plausible(const Sparse<double>& p) {
  for (std::size_t i = 0; i + 1 < p.starts.size(); ++i)
    if (p.starts[i] > p.starts[i + 1] || p.starts[i + 1] > p.column.size()) return false;
  for (const std::uint32_t j : p.column)
    if (j >= p.columns) return false;
  for (const double v : p.value)
    if (!std::isfinite(v)) return false;
  return p.starts.front() == 0 && p.starts.back() == p.column.size();
}

}  // namespace

Multigrid::Multigrid(std::unique_ptr<Process> process) : process_(std::move(process)) {}
Multigrid::~Multigrid() = default;

Result<std::unique_ptr<Multigrid>> Multigrid::start() {
  const Result<std::string> program = find_program();
  if (!program) return program.status();
  auto process = std::make_unique<Process>();
  if (Status started = process->start(*program); !started.ok()) return started;
  return std::unique_ptr<Multigrid>(new Multigrid(std::move(process)));
}

Result<Sparse<double>> Multigrid::prolongation(const Sparse<double>& matrix, const Progress& progress) {
  if (matrix.column.size() > kMostEntries)
    return {StatusCode::limit, "too many points for one decomposition: hypre counts with 32 bits"};
  MatrixHeader header;
  header.rows = header.columns = matrix.rows();
  header.entries = static_cast<std::uint32_t>(matrix.column.size());
  std::vector<std::int32_t> starts(matrix.starts.begin(), matrix.starts.end());
  Status status = process_->send(&header, sizeof header, progress);
  if (status.ok()) status = process_->send(starts.data(), starts.size() * 4, progress);
  if (status.ok()) status = process_->send(matrix.column.data(), matrix.column.size() * 4, progress);
  if (status.ok()) status = process_->send(matrix.value.data(), matrix.value.size() * 8, progress);
  if (status.ok()) status = process_->receive(&header, sizeof header, progress);
  if (!status.ok()) return status;
  if (header.magic != kMultigridMagic || header.rows != matrix.rows() || header.columns > header.rows ||
      header.entries > std::uint64_t{header.rows} * 64)
    return failure("answered with garbage");
  Sparse<double> p;
  p.columns = header.columns;
  p.column.resize(header.entries);
  p.value.resize(header.entries);
  status = process_->receive(starts.data(), starts.size() * 4, progress);
  if (status.ok()) status = process_->receive(p.column.data(), p.column.size() * 4, progress);
  if (status.ok()) status = process_->receive(p.value.data(), p.value.size() * 8, progress);
  if (!status.ok()) return status;
  p.starts.assign(starts.begin(), starts.end());
  if (!plausible(p)) return failure("answered with garbage");
  return p;
}

}  // namespace dupin::amg
