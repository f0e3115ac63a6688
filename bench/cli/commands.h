#pragma once

#include <functional>

namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
}

namespace groundloop::bench {

/// What the chosen subcommand does; returns the exit code.
using CommandAction = std::function<int()>;

/// Adds every subcommand. When one is parsed, `action` becomes its doing.
void add_commands(CLI::App& app, CommandAction& action);

void add_run_command(CLI::App& app, CommandAction& action);
void add_oracles_command(CLI::App& app, CommandAction& action);
void add_replay_command(CLI::App& app, CommandAction& action);
void add_eval_command(CLI::App& app, CommandAction& action);
void add_validate_command(CLI::App& app, CommandAction& action);
void add_preview_command(CLI::App& app, CommandAction& action);
void add_frame_command(CLI::App& app, CommandAction& action);
void add_list_command(CLI::App& app, CommandAction& action);
void add_cache_command(CLI::App& app, CommandAction& action);

}  // namespace groundloop::bench
