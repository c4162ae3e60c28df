// The subcommands. Each adds its own options; `chosen` becomes what it does once the command line has named
// it.
#ifndef DUPIN_APP_COMMANDS_H
#define DUPIN_APP_COMMANDS_H

#include <functional>

namespace CLI {
class App;
}

namespace dupin::app {

/// Does the work and returns the exit code.
using Command = std::function<int()>;

void add_info_command(CLI::App& app, Command& chosen);
void add_render_command(CLI::App& app, Command& chosen);
void add_sample_command(CLI::App& app, Command& chosen);
void add_tree_command(CLI::App& app, Command& chosen);
void add_view_command(CLI::App& app, Command& chosen);
void add_compare_command(CLI::App& app, Command& chosen);

}  // namespace dupin::app

#endif
