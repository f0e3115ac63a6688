#pragma once

#include "bench/metrics/metrics.h"
#include "bench/report/run_folder.h"
#include "bench/verdict/verdict.h"
#include "sim/scenario/scenario.h"

namespace groundloop::bench {

/// Every expectation beside what was measured, for run.json and the report.
std::vector<JudgedMetric> judged_metrics(const sim::Expectations& expected, const Metrics& measured,
                                         const Verdict& verdict);

/// Version, verdict and instruction set; the caller adds what it knows of the inputs.
RunHeader run_header(const Verdict& verdict);

}  // namespace groundloop::bench
