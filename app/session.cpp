#include "session.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "../core/parallel.h"

namespace dupin::app {

void add_common_options(CLI::App& command, CommonOptions& options) {
  const char* group = "Common options";
  auto* quiet =
      command.add_flag("--quiet", options.quiet, "Say nothing but why the command failed")->group(group);
  command.add_flag("--verbose", options.verbose, "Also say what was done, and how long each stage took")
      ->group(group)
      ->excludes(quiet);
  command
      .add_option("--threads", options.threads,
                  "Threads to use; the result does not depend on it (default: one per core)")
      ->check(CLI::Range(1, 1024))
      ->group(group);
  command.add_flag("--no-progress", options.no_progress, "No progress bar on the terminal")->group(group);
  command
      .add_option("--time-limit", options.time_limit_seconds, "Give up after so many seconds (exit code 5)")
      ->check(CLI::PositiveNumber)
      ->type_name("S")
      ->group(group);
  command
      .add_option(
          "--memory-limit", options.memory_limit_bytes,
          "Give up when the reader or the command takes more memory (exit code 5); K, M, G may follow")
      ->transform(CLI::AsSizeValue(false))
      ->check(CLI::PositiveNumber)
      ->type_name("BYTES")
      ->group(group);
  command
      .add_flag("--strict", options.strict,
                "Exit code 4 for any face that cannot be drawn, from `info` too (`render` has it always)")
      ->group(group);
  command.add_option("--units", options.units, "The unit of files that name none")
      ->check(CLI::IsMember({"um", "mm", "cm", "m", "inch", "ft"}))
      ->capture_default_str()
      ->group(group);
}

Session::Session(const CommonOptions& options)
    : options_(options),
      bar_(!options.quiet && !options.no_progress),
      limits_(options.time_limit_seconds, options.memory_limit_bytes) {
  if (options.threads <= 0) return;
  set_thread_limit(options.threads);
  // Mesa's software rasteriser has threads of its own; a user's setting of it stays.
  setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 0);
}

Progress Session::progress() {
  return [this](std::string_view stage, double fraction) {
    bar_.show(stage, fraction);
    return !limits_.time_is_over();
  };
}

void Session::warn(const std::string& message) {
  if (options_.quiet) return;
  bar_.clear();
  say(message);
}

void Session::note(const std::string& message) {
  if (!options_.verbose) return;
  bar_.clear();
  say(message);
}

int Session::fail(const Status& status) {
  bar_.clear();
  if (status.code != StatusCode::cancelled) return app::fail(status);
  char text[64];
  std::snprintf(text, sizeof text, "the time limit of %g s was reached", limits_.seconds());
  return app::fail({StatusCode::limit, text});
}

}  // namespace dupin::app
