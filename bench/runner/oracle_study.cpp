#include "bench/runner/oracle_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "bench/report/report.h"
#include "bench/runner/slam_options.h"
#include "slam/mapping/atomic_file.h"

namespace groundloop::bench {
namespace {

using nlohmann::ordered_json;
using slam::OracleStage;

const std::vector<OracleStages>& variants() {
  static const std::vector<OracleStages> kVariants = {{},
                                                      {OracleStage::kTracking},
                                                      {OracleStage::kStereo},
                                                      {OracleStage::kTracking, OracleStage::kStereo},
                                                      {OracleStage::kMotion},
                                                      {OracleStage::kLoops}};
  return kVariants;
}

std::string folder_name(const OracleStages& exact) {
  return exact.empty() ? "as_it_is" : "exact_" + name_of(exact);
}

/// [{"exact": "tracking", "outcome": "pass", "metrics": {...}}, ...]
void write_table(const std::string& file, const std::vector<RunOutcome>& runs) {
  ordered_json rows = ordered_json::array();
  for (const RunOutcome& run : runs) {
    ordered_json metrics = ordered_json::object();
    for (const std::string& name : study_metrics()) {
      if (const auto found = run.metrics.find(name); found != run.metrics.end())
        metrics[name] = found->second;
    }
    rows.push_back(
        {{"exact", name_of(run.oracles)}, {"outcome", name_of(run.verdict.outcome)}, {"metrics", metrics}});
  }
  slam::write_file_atomically(file, [&](std::ostream& out) { out << rows.dump(2) << "\n"; });
}

}  // namespace

const std::vector<std::string>& study_metrics() {
  static const std::vector<std::string> kMetrics = {"trajectory.ate_rmse_m", "trajectory.end_yaw_deg",
                                                    "trajectory.drift_5m_percent", "trajectory.lost_frames",
                                                    "map.f1"};
  return kMetrics;
}

std::vector<RunOutcome> oracle_study(const OracleStudyOptions& options, const JobControl& control) {
  sim::Scenario scenario = sim::load_scenario(options.scenario, options.set);
  slam_options(scenario);  // complains before anything is run
  scenario.seed = options.seed.value_or(scenario.seed);
  const std::string name = fmt::format("{}-{}", scenario.name, scenario.seed);
  const std::string parent = options.out.empty() ? "runs/" + name + "-oracles" : options.out;
  const std::unique_ptr<sim::PairCache> cache = open_cache(options.cache);
  std::vector<RunJob> jobs;
  for (const OracleStages& exact : variants()) {
    jobs.push_back({scenario, options.frames, exact, parent + "/" + folder_name(exact), cache.get()});
  }
  std::vector<RunOutcome> runs = run_all(jobs, options.jobs, control);
  if (cache) cache->trim();
  const std::string& first = runs.front().folder;
  if (!first.empty()) {
    write_table(first + "/oracles.json", runs);
    write_report(first);
  }
  return runs;
}

}  // namespace groundloop::bench
