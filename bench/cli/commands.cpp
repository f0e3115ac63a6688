#include "bench/cli/commands.h"

namespace groundloop::bench {

void add_commands(CLI::App& app, CommandAction& action) {
  add_run_command(app, action);
  add_oracles_command(app, action);
  add_replay_command(app, action);
  add_eval_command(app, action);
  add_validate_command(app, action);
  add_preview_command(app, action);
  add_frame_command(app, action);
  add_list_command(app, action);
  add_cache_command(app, action);
}

}  // namespace groundloop::bench
