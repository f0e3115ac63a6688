// groundloop run and groundloop replay: the bench at work.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/cli/progress.h"
#include "bench/cli/run_answer.h"
#include "bench/cli/seed_summary.h"
#include "bench/runner/replay.h"
#include "bench/runner/run.h"
#include "bench/verdict/junit.h"
#include "slam/pipeline/options.h"

namespace groundloop::bench {
namespace {

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
    for (const RunOutcome& run : runs) judged.push_back({run.title(), run.seed, run.wall_s, run.verdict});
    write_junit(options.junit, "groundloop", judged);
  }
  const int code = report(runs, true, options.json);
  if (!options.json) fmt::print("{}", seed_summary(runs));
  return code;
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
  std::vector<std::string> oracles;
};

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
  add_repeatable(*command, "--oracle", raw->oracles,
                 "replace a stage by exact answers: tracking, stereo, motion or loops; repeatable. An "
                 "experiment: the run says so everywhere")
      ->type_name("STAGE");
  command
      ->add_option("--out", options->out, "run folder (of several runs: its parent); default runs/NAME-SEED")
      ->type_name("DIR");
  command->add_option("--junit", options->junit, "write the verdicts as JUnit XML")->type_name("FILE");
  command->add_option("--jobs", options->jobs, "runs at the same time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("N");
  add_cache(*command, options->cache);
  add_renderer(*command);
  command->add_flag("--json", options->json, "print the verdicts and metrics as JSON");
  command->callback([=, &action] {
    action = [=] {
      if (!raw->seeds.empty()) options->seeds = parse_seeds(raw->seeds);
      options->set = overrides_of(raw->set);
      options->oracles = parse_stages(raw->oracles);
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
  command
      ->add_option("--calibration", options->calibration,
                   "the images are raw: stereo calibration in OpenCV's YAML, in one file or two")
      ->expected(1, 2)
      ->type_name("FILE");
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
