#include "bench/cli/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/cli/commands.h"
#include "bench/runner/core_run.h"
#include "bench/verdict/verdict.h"
#include "slam/types/config.h"

namespace groundloop::bench {
namespace {

constexpr int kInterruptedExit = 130;  // as a shell reports a program that Ctrl-C ended

int complain(Outcome outcome, const std::string& text) {
  fmt::print(stderr, "groundloop: {}\n", text);
  return exit_code(outcome);
}

/// CLI11 speaks of missing subcommands before it looks at what was given instead.
void check_command(CLI::App& app, char** argv) {
  if (argv[1][0] == '-') return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == argv[1]) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw InputError(Problem{"", 0, "unknown command", argv[1], "one of: " + names});
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Simulation-in-the-loop test bench for stereo SLAM.", "groundloop");
  app.set_version_flag("--version", "groundloop " GROUNDLOOP_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 pass, 1 the SLAM fell short, 2 bad input, 3 internal error, 130 stopped by Ctrl-C.");
  CommandAction action;
  add_commands(app, action);
  if (argc < 2) {
    fmt::print(stderr, "{}", app.help());
    return exit_code(Outcome::kBadInput);
  }
  check_command(app, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    const auto chosen = app.get_subcommands();
    return complain(Outcome::kBadInput, fmt::format("{}\nSee groundloop {}--help", error.what(),
                                                    chosen.empty() ? "" : chosen.front()->get_name() + " "));
  }
  return action();
}

}  // namespace

int run_cli(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) fmt::print(stderr, "{}\n", problem.text());
    return exit_code(Outcome::kBadInput);
  } catch (const Interrupted& stopped) {
    fmt::print(stderr, "groundloop: {}\n", stopped.what());
    return kInterruptedExit;
  } catch (const std::exception& error) {
    return complain(Outcome::kInternalError, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace groundloop::bench
