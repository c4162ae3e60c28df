// dupin: draws CAD models from their exact surfaces. docs/manual.md is its manual.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "commands.h"
#include "console.h"
#include "exit_code.h"
#include "output_file.h"
#include "study/commands.h"

namespace {

using dupin::app::kDone;
using dupin::app::kWrongUsage;

/// What CLI11 says about a wrong command line, in one line and with where to read on.
std::string usage_error(const CLI::App& app, int argc, char** argv, const CLI::ParseError& error) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty()) return "no command; see dupin --help";
  const auto commands =
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == first; });
  if (first[0] != '-' && commands.empty()) return "'" + first + "' is no command; see dupin --help";
  const bool named = first[0] != '-';
  return std::string(error.what()) + "; see dupin " + (named ? first + " " : "") + "--help";
}

int run(int argc, char** argv) {
  CLI::App app{"Draws CAD models from their exact surfaces, without tessellating them.", "dupin"};
  app.set_version_flag("--version", "dupin " DUPIN_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 wrong usage, 3 unreadable or unsupported input or unwritable output,\n"
      "4 done but faces were left out (each is listed), 5 a limit was hit, 6 no GL device.");
  dupin::app::Command chosen;
  dupin::app::add_info_command(app, chosen);
  dupin::app::add_render_command(app, chosen);
  dupin::app::add_sample_command(app, chosen);
  dupin::app::add_tree_command(app, chosen);
  dupin::app::add_view_command(app, chosen);
  dupin::app::add_compare_command(app, chosen);
  dupin::app::add_study_command(app, chosen);
  dupin::app::add_bench_command(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    dupin::app::say(usage_error(app, argc, argv, error));
    return kWrongUsage;
  }
  return chosen ? chosen() : kWrongUsage;
}

}  // namespace

int main(int argc, char** argv) {
  dupin::app::remove_unfinished_outputs_on_signals();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    dupin::app::remove_unfinished_outputs();
    dupin::app::say(std::string("internal error: ") + error.what());
    return dupin::app::kUnreadable;
  }
}
