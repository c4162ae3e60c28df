#include "worker.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace dupin::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kTold = 3;  // the exit code of a worker that could not go on and has nobody to tell

void send(int pipe, const Json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(pipe, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(kTold);
    at += static_cast<std::size_t>(n);
  }
}

bool same_picture(const StudyRow& a, const StudyRow& b) {
  return a.view.name == b.view.name && a.width == b.width && a.height == b.height;
}

/// Rows that are ready at once and take turns: only where frames or repeated preparations are timed does that
/// matter, and finishing rows one by one loses less when a run is ended.
std::size_t at_once(const Study& study) {
  return study.frames > 0 || study.prepares > 1 ? kMostAtOnce : 1;
}

void measure(const Study& study, const CommonOptions& common, const std::string& folder,
             const std::vector<const StudyRow*>& rows, int pipe) {
  Measurer measurer(study, common, folder);
  MeasureHooks hooks;
  hooks.at = [&](std::size_t row) { send(pipe, {{"at", row}}); };
  hooks.done = [&](RowResult result) {
    send(pipe, {{"row", result.row},
                {"failure", result.failure},
                {"results", result.results},
                {"times", result.times},
                {"pictures", result.pictures},
                {"command", result.command},
                {"gl_renderer", measurer.gl_renderer()}});
  };
  for (std::size_t i = 0; i < rows.size();) {
    std::size_t end = i + 1;
    while (end < rows.size() && end - i < at_once(study) && same_picture(*rows[i], *rows[end])) ++end;
    measurer.measure(
        {rows.begin() + static_cast<std::ptrdiff_t>(i), rows.begin() + static_cast<std::ptrdiff_t>(end)},
        hooks);
    i = end;
  }
}

std::optional<Worker::Message> parse(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Worker::Message message;
  if (json.contains("at")) {
    message.row = json["at"];
    return message;
  }
  message.done = true;
  message.result.row = message.row = json["row"];
  message.result.failure = json["failure"];
  message.result.results = json["results"];
  message.result.times = json["times"];
  message.result.pictures = json["pictures"];
  message.result.command = json["command"];
  message.gl_renderer = json["gl_renderer"];
  return message;
}

}  // namespace

Worker::Worker(const Study& study, const CommonOptions& common, const std::string& folder,
               const std::vector<const StudyRow*>& rows) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return;
  process_ = fork();
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would hear what it finds
    close(ends[0]);
    CommonOptions silent = common;
    silent.quiet = silent.no_progress = true;
    silent.time_limit_seconds = 0;  // of the whole command, which watches itself
    measure(study, silent, folder, rows, ends[1]);
    _exit(0);
  }
  close(ends[1]);
  pipe_ = ends[0];
}

Worker::~Worker() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (pipe_ >= 0) close(pipe_);
}

bool Worker::read_more(double seconds) {
  pollfd wait{pipe_, POLLIN, 0};
  int ready = 0;
  do ready = poll(&wait, 1, static_cast<int>(std::min(seconds * 1e3, 2e9)));
  while (ready < 0 && errno == EINTR);
  if (ready == 0) return late_ = true, false;
  char buffer[65536];
  const ssize_t n = read(pipe_, buffer, sizeof buffer);
  if (n <= 0) return false;
  text_.append(buffer, static_cast<std::size_t>(n));
  return true;
}

std::optional<Worker::Message> Worker::next(double seconds) {
  for (;;) {
    if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
      const std::string line = text_.substr(0, end);
      text_.erase(0, end + 1);
      if (auto message = parse(line)) return message;
      continue;
    }
    if (pipe_ < 0 || !read_more(seconds)) return std::nullopt;
  }
}

std::string Worker::end() {
  if (process_ < 0) return "no process could be started";
  if (late_) return "took too long";
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = 0;
  if (WIFSIGNALED(status))
    return std::string("the process that measured it died: ") + strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) return "the process that measured it ended early (a limit of memory?)";
  return {};
}

}  // namespace dupin::app
