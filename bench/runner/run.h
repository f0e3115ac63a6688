#pragma once

#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/runner/options.h"
#include "bench/verdict/verdict.h"
#include "sim/scenario/scenario.h"

namespace groundloop::bench {

/// One finished run.
struct RunOutcome {
  std::string name;
  uint64_t seed = 0;
  std::string folder;  ///< empty when nothing was written
  double wall_s = 0;
  Metrics metrics;
  Verdict verdict;
};

/// Simulates one scenario, runs the core on what its head sees, judges it and writes the run folder.
/// @throws InputError, Interrupted
RunOutcome run_scenario(const sim::Scenario& scenario, std::optional<int64_t> frames,
                        const std::string& folder, const JobControl& control);

/// `groundloop run`: every scenario with every seed, `jobs` at a time. A run that fails does not stop the
/// others.
/// @return in the order of scenarios and seeds
/// @throws InputError when a scenario file is wrong (before anything is run), Interrupted
std::vector<RunOutcome> run(const RunOptions& options, const JobControl& control);

}  // namespace groundloop::bench
