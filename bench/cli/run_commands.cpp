// groundloop run and groundloop replay: the bench at work.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/cli/interrupt.h"
#include "bench/cli/progress.h"
#include "bench/runner/replay.h"
#include "bench/runner/run.h"
#include "bench/verdict/junit.h"
#include "slam/pipeline/options.h"

namespace groundloop::bench {
namespace {

using nlohmann::ordered_json;

/// The metrics that the one line of a run shows, where they were measured.
struct Headline {
  const char* metric;
  const char* format;
};
constexpr Headline kHeadlines[] = {{"trajectory.ate_rmse_m", "ATE {:.3f} m"},
                                   {"trajectory.planar_rmse_m", "planar {:.4f} m"},
                                   {"trajectory.drift_5m_percent", "drift {:.2f} %"},
                                   {"trajectory.end_yaw_deg", "end yaw {:.2f} deg"},
                                   {"map.f1", "map F1 {:.3f}"},
                                   {"trajectory.lost_frames", "lost {:.0f}"},
                                   {"timing.slam_ms_median", "SLAM {:.1f} ms"}};

std::string headline(const Metrics& metrics) {
  std::string text;
  for (const Headline& shown : kHeadlines) {
    const auto found = metrics.find(shown.metric);
    if (found != metrics.end()) text += "  " + fmt::format(fmt::runtime(shown.format), found->second);
  }
  return text;
}

/// @param seeded  false for a recording, which has no seed
void print_text(const RunOutcome& run, bool seeded) {
  const std::string seed = seeded ? fmt::format(" seed {}", run.seed) : "";
  fmt::print("{}{}: {}{}\n", run.name, seed, name_of(run.verdict.outcome), headline(run.metrics));
  for (const Shortfall& missed : run.verdict.shortfalls) fmt::print("  {}\n", missed.text());
  if (run.verdict.outcome > Outcome::kFellShort) fmt::print(stderr, "{}\n", run.verdict.message);
  if (!run.folder.empty()) fmt::print("  {}/report.html\n", run.folder);
}

ordered_json as_json(const RunOutcome& run) {
  ordered_json shortfalls = ordered_json::array();
  for (const Shortfall& missed : run.verdict.shortfalls) {
    ordered_json entry = {{"metric", missed.metric}};
    entry["value"] = missed.value ? ordered_json(*missed.value) : ordered_json(nullptr);
    if (missed.min) entry["min"] = *missed.min;
    if (missed.max) entry["max"] = *missed.max;
    shortfalls.push_back(entry);
  }
  return {{"name", run.name},
          {"seed", run.seed},
          {"outcome", name_of(run.verdict.outcome)},
          {"message", run.verdict.message},
          {"shortfalls", shortfalls},
          {"folder", run.folder},
          {"wall_s", run.wall_s},
          {"metrics", run.metrics}};
}

/// Reports what came out; the exit code is that of the worst run.
int report(const std::vector<RunOutcome>& runs, bool seeded, bool json) {
  std::vector<Verdict> verdicts;
  ordered_json answer = ordered_json::array();
  for (const RunOutcome& run : runs) {
    verdicts.push_back(run.verdict);
    if (json) {
      answer.push_back(as_json(run));
    } else {
      print_text(run, seeded);
    }
  }
  if (json) fmt::print("{}\n", answer.dump(2));
  return exit_code(worst(verdicts));
}

JobControl control_with(Progress& progress) {
  JobControl control;
  control.progress = [&progress](const std::string& run, int64_t done, int64_t total) {
    progress.update(run, done, total);
  };
  control.stop = &stop_on_interrupt();
  return control;
}

/// Long runs must not end with a verdict that cannot be written.
void check_writable(const std::string& file) {
  if (!std::ofstream(file, std::ios::app)) {
    throw InputError(Problem{"", 0, "--junit", file, "a file in a writable folder"});
  }
}

int run_scenarios(const RunOptions& options) {
  if (!options.junit.empty()) check_writable(options.junit);
  std::vector<RunOutcome> runs;
  {
    Progress progress;
    runs = run(options, control_with(progress));
  }
  if (!options.junit.empty()) {
    std::vector<JudgedRun> judged;
    judged.reserve(runs.size());
    for (const RunOutcome& run : runs) judged.push_back({run.name, run.seed, run.wall_s, run.verdict});
    write_junit(options.junit, "groundloop", judged);
  }
  return report(runs, true, options.json);
}

int replay_sequence(const ReplayOptions& options) {
  std::vector<RunOutcome> runs;
  {
    Progress progress;
    runs.push_back(replay(options, control_with(progress)));
  }
  return report(runs, false, options.json);
}

/// Text that is parsed once the command line is known to be good.
struct RawArguments {
  std::string seeds;
  std::vector<std::string> set;
};

std::vector<sim::Override> overrides_of(const std::vector<std::string>& texts) {
  std::vector<sim::Override> overrides;
  overrides.reserve(texts.size());
  for (const std::string& text : texts) overrides.push_back(parse_override(text));
  return overrides;
}

CLI::Option* add_set(CLI::App& command, std::vector<std::string>& set, const std::string& help) {
  return command.add_option("--set", set, help)->type_name("KEY=VALUE")->expected(1)->allow_extra_args(false);
}

}  // namespace

void add_run_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("run", "simulate, SLAM, judge");
  const auto options = std::make_shared<RunOptions>();
  const auto raw = std::make_shared<RawArguments>();
  command->add_option("scenario", options->scenarios, "scenario files")->required()->type_name("FILE");
  command->add_option("--seed", raw->seeds, "in place of the scenario's: S, or A..B for one run each")
      ->type_name("S");
  command->add_option("--frames", options->frames, "only the first N pairs")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  add_set(*command, raw->set,
          "set a key of the scenario, such as plan.speed_mps=0.2 or slam.preset=paper; repeatable");
  command
      ->add_option("--out", options->out, "run folder (of several runs: its parent); default runs/NAME-SEED")
      ->type_name("DIR");
  command->add_option("--junit", options->junit, "write the verdicts as JUnit XML")->type_name("FILE");
  command->add_option("--jobs", options->jobs, "runs at the same time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--json", options->json, "print the verdicts and metrics as JSON");
  command->callback([=, &action] {
    action = [=] {
      if (!raw->seeds.empty()) options->seeds = parse_seeds(raw->seeds);
      options->set = overrides_of(raw->set);
      return run_scenarios(*options);
    };
  });
}

void add_replay_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("replay", "the same core on a recorded sequence");
  const auto options = std::make_shared<ReplayOptions>();
  const auto raw = std::make_shared<RawArguments>();
  command->add_option("dir", options->dir, "folder of the sequence")->required()->type_name("DIR");
  command->add_option("--format", options->format, "layout of the folder; default: told from what is in it")
      ->check(CLI::IsMember({"kitti", "euroc"}))
      ->type_name("NAME");
  command->add_option("--preset", options->preset, "options of the core")
      ->check(CLI::IsMember(slam::preset_names()))
      ->capture_default_str()
      ->type_name("NAME");
  add_set(*command, raw->set, "set an option of the core, such as tracking.max_features=400; repeatable");
  command->add_option("--frames", options->frames, "only the first N pairs")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_option("--truth", options->truth, "trajectory to judge by; default: the sequence's own")
      ->type_name("FILE");
  command->add_option("--out", options->out, "run folder; default runs/NAME")->type_name("DIR");
  command->add_flag("--json", options->json, "print the verdict and metrics as JSON");
  command->callback([=, &action] {
    action = [=] {
      options->set = overrides_of(raw->set);
      return replay_sequence(*options);
    };
  });
}

}  // namespace groundloop::bench
