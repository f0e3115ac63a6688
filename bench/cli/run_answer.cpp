#include "bench/cli/run_answer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/cli/interrupt.h"

namespace groundloop::bench {
namespace {

using nlohmann::ordered_json;

/// The metrics that the one line of a run shows, where they were measured.
struct Headline {
  const char* metric;
  const char* format;
};
constexpr Headline kHeadlines[] = {{"trajectory.ate_rmse_m", "ATE {:.4f} m"},
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
  fmt::print("{}{}: {}{}\n", run.title(), seed, name_of(run.verdict.outcome), headline(run.metrics));
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
          {"oracles", name_of(run.oracles)},
          {"outcome", name_of(run.verdict.outcome)},
          {"message", run.verdict.message},
          {"shortfalls", shortfalls},
          {"folder", run.folder},
          {"wall_s", run.wall_s},
          {"metrics", run.metrics}};
}

}  // namespace

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
  control.note = [&progress](const std::string& run, const std::string& line) { progress.note(run, line); };
  control.stop = &stop_on_interrupt();
  return control;
}

}  // namespace groundloop::bench
