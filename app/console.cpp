#include "console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exit_code.h"

namespace dupin::app {
namespace {
constexpr auto kRedrawInterval = std::chrono::milliseconds(50);
constexpr int kBarWidth = 30;
}  // namespace

ProgressBar::ProgressBar(bool wanted) : enabled_(wanted && isatty(STDERR_FILENO)) {}

void ProgressBar::show(std::string_view stage, double fraction) {
  if (!enabled_) return;
  const std::scoped_lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_ < kRedrawInterval) return;
  last_ = now;
  drawn_ = true;
  const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const std::string bar(static_cast<std::size_t>(std::lround(part * kBarWidth)), '#');
  std::fprintf(stderr, "\r\033[K[%-*s] %3.0f %%  %.*s", kBarWidth, bar.c_str(), 100 * part,
               static_cast<int>(stage.size()), stage.data());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  const std::scoped_lock lock(mutex_);
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void say(const std::string& message) {
  std::string line = message;
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  std::fprintf(stderr, "dupin: %s\n", line.c_str());
}

int fail(const Status& status) {
  say(status.message.empty() ? "failed" : status.message);
  return exit_code(status.code);
}

}  // namespace dupin::app
