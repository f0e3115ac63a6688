// groundloop oracles: each stage's part of the error.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/cli/run_answer.h"
#include "bench/runner/oracle_study.h"

namespace groundloop::bench {
namespace {

std::optional<double> value_of(const RunOutcome& run, const std::string& metric) {
  const auto found = run.metrics.find(metric);
  return found == run.metrics.end() ? std::nullopt : std::optional(found->second);
}

/// "0.0123 (-45 %)": the value, and by how much it differs from that of the run as it is.
std::string cell(const RunOutcome& run, const RunOutcome& as_it_is, const std::string& metric) {
  const auto value = value_of(run, metric), base = value_of(as_it_is, metric);
  if (!value) return "-";
  const std::string text = fmt::format("{:.4g}", *value);
  if (&run == &as_it_is || !base || *base == 0) return text;
  return fmt::format("{} ({:+.0f} %)", text, 100 * (*value / *base - 1));
}

void print_table(const std::vector<RunOutcome>& runs) {
  fmt::print("\n{:<18}", "exact");
  for (const std::string& metric : study_metrics()) fmt::print("{:>29}", metric);
  fmt::print("\n");
  for (const RunOutcome& run : runs) {
    fmt::print("{:<18}", run.oracles.empty() ? "nothing" : name_of(run.oracles));
    for (const std::string& metric : study_metrics()) fmt::print("{:>29}", cell(run, runs.front(), metric));
    fmt::print("\n");
  }
}

int study(const OracleStudyOptions& options) {
  std::vector<RunOutcome> runs;
  {
    Progress progress;
    runs = oracle_study(options, control_with(progress));
  }
  const int code = report(runs, true, options.json);
  if (!options.json) print_table(runs);
  return code;
}

}  // namespace

void add_oracles_command(CLI::App& app, CommandAction& action) {
  CLI::App* command =
      app.add_subcommand("oracles", "each stage's part of the error: runs with exact answers in its place");
  const auto options = std::make_shared<OracleStudyOptions>();
  const auto set = std::make_shared<std::vector<std::string>>();
  command->add_option("scenario", options->scenario, "scenario file")->required()->type_name("FILE");
  command->add_option("--seed", options->seed, "in place of the scenario's")->type_name("S");
  command->add_option("--frames", options->frames, "only the first N pairs")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  add_set(*command, *set, "set a key of the scenario, such as slam.preset=paper; repeatable");
  command->add_option("--out", options->out, "parent of the run folders; default runs/NAME-SEED-oracles")
      ->type_name("DIR");
  command->add_option("--jobs", options->jobs, "runs at the same time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("N");
  add_cache(*command, options->cache);
  add_renderer(*command);
  command->add_flag("--json", options->json, "print the verdicts and metrics as JSON");
  command->callback([=, &action] {
    action = [=] {
      options->set = overrides_of(*set);
      return study(*options);
    };
  });
}

}  // namespace groundloop::bench
