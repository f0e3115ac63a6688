#include "bench/cli/seed_summary.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "bench/metrics/uncertainty.h"

namespace groundloop::bench {
namespace {

struct Seeds {
  NeesSum nees;
  int runs = 0;  ///< that measured it
};

std::string line_of(const std::string& title, const Seeds& seeds) {
  const double mean = seeds.nees.sum / static_cast<double>(seeds.nees.samples);
  const NeesBounds bounds = nees_bounds(seeds.nees.samples);
  const char* verdict = mean > bounds.high  ? "outside: too sure of itself"
                        : mean < bounds.low ? "outside: too modest"
                                            : "inside";
  return fmt::format("{} over {} seeds: NEES {:.2f} of 6, 95 % bounds {:.2f} to {:.2f} ({} key frames): {}\n",
                     title, seeds.runs, mean, bounds.low, bounds.high, seeds.nees.samples, verdict);
}

}  // namespace

std::string seed_summary(const std::vector<RunOutcome>& runs) {
  std::map<std::string, Seeds> scenarios;
  for (const RunOutcome& run : runs) {
    const auto mean = run.metrics.find("uncertainty.nees_mean");
    const auto samples = run.metrics.find("uncertainty.nees_samples");
    if (mean == run.metrics.end() || samples == run.metrics.end()) continue;
    Seeds& seeds = scenarios[run.title()];
    seeds.nees.sum += mean->second * samples->second;
    seeds.nees.samples += std::llround(samples->second);
    ++seeds.runs;
  }
  std::string text;
  for (const auto& [title, seeds] : scenarios) {
    if (seeds.runs > 1) text += line_of(title, seeds);
  }
  return text;
}

}  // namespace groundloop::bench
