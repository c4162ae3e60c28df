// dupin study: sweeps over models, views and options, from a TOML file.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>

#include "../exit_code.h"
#include "commands.h"
#include "study_run.h"

namespace dupin::app {
namespace {

struct StudyOptions {
  StudyRun run;
  std::string file, shard;
  bool list = false;
};

/// "I/N"
Status read_shard(const std::string& text, RunOptions& run) {
  int length = 0;
  if (text.empty()) return {};
  if (std::sscanf(text.c_str(), "%d/%d%n", &run.shard, &run.shards, &length) != 2 ||
      static_cast<std::size_t>(length) != text.size() || run.shard < 1 || run.shard > run.shards)
    return {StatusCode::invalid_argument, "--shard takes I/N, with I from 1 to N; not '" + text + "'"};
  return {};
}

int run(StudyOptions options) {
  if (const Status status = read_shard(options.shard, options.run.run); !status.ok()) return fail(status);
  if (options.run.merge && !options.shard.empty())
    return fail({StatusCode::invalid_argument, "--shard and --merge exclude each other"});
  const Result<Study> study = read_study(options.file);
  if (!study.ok()) return fail(study.status());
  if (options.list) return list_rows(*study), kDone;
  if (options.run.run.folder.empty())
    return fail({StatusCode::invalid_argument, "-o FOLDER is missing; see dupin study --help"});
  std::ifstream in(options.file, std::ios::binary);
  options.run.text.assign(std::istreambuf_iterator<char>(in), {});
  return run_study(*study, options.run);
}

}  // namespace

void add_study_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* command = app.add_subcommand("study", "Measure sweeps over models, views and options");
  command->add_option("STUDY", options->file, "The study, as TOML (docs/studies.md)")->required();
  command
      ->add_option("-o,--output", options->run.run.folder,
                   "The folder of results; a run that was ended goes on there")
      ->type_name("FOLDER");
  command->add_option("--shard", options->shard, "Measure the I-th of N parts of the rows")->type_name("I/N");
  command->add_flag("--merge", options->run.merge,
                    "Measure nothing; join the rows that all shards have measured");
  command->add_option("--from", options->run.journals, "Further folders with rows that were measured")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER");
  command->add_flag("--list", options->list, "Measure nothing; list the rows");
  command->add_flag("!--no-report", options->run.report, "No report.html");
  add_common_options(*command, options->run.run.common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
