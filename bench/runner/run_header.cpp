#include "bench/runner/run_header.h"

#include <algorithm>

#include "bench/runner/provenance.h"

namespace groundloop::bench {

std::vector<JudgedMetric> judged_metrics(const sim::Expectations& expected, const Metrics& measured,
                                         const Verdict& verdict) {
  std::vector<JudgedMetric> lines;
  const auto add = [&](const std::string& metric, std::optional<double> min, std::optional<double> max,
                       bool ok) {
    const auto found = measured.find(metric);
    const std::optional<double> value = found == measured.end() ? std::nullopt : std::optional(found->second);
    lines.push_back({metric, value, min, max, ok});
  };
  for (const Shortfall& missed : verdict.shortfalls) {
    if (expected.metrics.count(missed.metric) == 0) add(missed.metric, missed.min, missed.max, false);
  }
  for (const auto& [metric, bounds] : expected.metrics) {
    const bool missed = std::any_of(verdict.shortfalls.begin(), verdict.shortfalls.end(),
                                    [&m = metric](const Shortfall& s) { return s.metric == m; });
    add(metric, bounds.min, bounds.max, !missed);
  }
  return lines;
}

RunHeader run_header(const Verdict& verdict) {
  RunHeader header;
  header.version = GROUNDLOOP_VERSION;
  header.isa = instruction_set();
  header.result = name_of(verdict.outcome);
  return header;
}

}  // namespace groundloop::bench
