// The subcommands that measure.
#ifndef DUPIN_APP_STUDY_COMMANDS_H
#define DUPIN_APP_STUDY_COMMANDS_H

#include "../commands.h"

namespace dupin::app {

void add_study_command(CLI::App& app, Command& chosen);
void add_bench_command(CLI::App& app, Command& chosen);

}  // namespace dupin::app

#endif
