#pragma once

#include <memory>
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
  OracleStages oracles;

  /// "lab_p3dx", or "lab_p3dx (exact tracking)".
  std::string title() const;
};

/// One run to be made.
struct RunJob {
  sim::Scenario scenario;         ///< with its seed
  std::optional<int64_t> frames;  ///< only the first so many pairs
  OracleStages oracles;
  std::string folder;
  sim::PairCache* cache = nullptr;  ///< finished pairs; null: all are rendered
};

/// Simulates one scenario, runs the core on what its head sees, judges it and writes the run folder.
/// @throws InputError, Interrupted
RunOutcome run_scenario(const RunJob& job, const JobControl& control);

/// The cache that was chosen; null for none.
/// @throws InputError when its folder cannot be made
std::unique_ptr<sim::PairCache> open_cache(const CacheChoice& choice);

/// Several, `at_once` at a time. A run that fails does not stop the others.
/// @return in the order of the jobs
/// @throws Interrupted
std::vector<RunOutcome> run_all(const std::vector<RunJob>& jobs, int at_once, const JobControl& control);

/// `groundloop run`: every scenario with every seed.
/// @return in the order of scenarios and seeds
/// @throws InputError when a scenario file is wrong (before anything is run), Interrupted
std::vector<RunOutcome> run(const RunOptions& options, const JobControl& control);

}  // namespace groundloop::bench
