// dupin view: starts the window, which is a program of its own (app/viewer), in this one's place.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "console.h"
#include "exit_code.h"

namespace dupin::app {
namespace {

struct ViewCommandOptions {
  std::vector<std::string> files;
  std::string units = "mm", report;
};

std::string viewer() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& place : {self / "dupin-view", self / "../libexec/dupin/dupin-view"})
    if (::access(place.c_str(), X_OK) == 0) return place.string();
  return {};
}

int run(const ViewCommandOptions& options) {
  const std::string program = viewer();
  if (program.empty())
    return fail(
        {StatusCode::unreadable, "the viewer (dupin-view) is not installed; it is built where Qt 5 is"});
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY") && !std::getenv("QT_QPA_PLATFORM"))
    return fail({StatusCode::no_device, "there is no display for a window"});
  std::vector<std::string> words{program, "--units", options.units};
  if (!options.report.empty()) words.insert(words.end(), {"--report", options.report});
  words.push_back("--");
  words.insert(words.end(), options.files.begin(), options.files.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return fail({StatusCode::unreadable, program + ": " + std::strerror(errno)});
}

}  // namespace

void add_view_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<ViewCommandOptions>();
  CLI::App* command = app.add_subcommand("view", "Look at models in a window");
  command->add_option("FILE", options->files,
                      "STEP, IGES, BREP, FCStd, OBJ, PLY, STL or OFF; all in one scene");
  command->add_option("--units", options->units, "The unit of files that name none")
      ->check(CLI::IsMember({"um", "mm", "cm", "m", "inch", "ft"}))
      ->capture_default_str();
  command->add_option("--report", options->report, "Write what the window did, as JSON, when it closes")
      ->type_name("FILE.json");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
