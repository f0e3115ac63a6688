#pragma once

#include <string>
#include <vector>

#include "bench/report/run_folder.h"

namespace groundloop::bench {

// The tables of the report as HTML.

/// "0.072 m": a metric's value, to so many significant digits, with the unit that its name ends in.
std::string value_with_unit(const std::string& metric, double value, int digits = 4);

/// One sentence for an expectation: metric, value and bound.
std::string judged_sentence(const JudgedMetric& judged);

/// The scenario's expectations, one row each.
std::string expectation_table(const RunHeader& header);

/// Each stage's part of the error: the run as it is, and runs with exact answers in place of stages. Empty
/// without rows.
std::string oracle_table(const std::vector<OracleRow>& rows);

/// All metrics, a table for each group (trajectory, tracking, map, stage, uncertainty, loop, timing, others).
std::string metric_tables(const std::map<std::string, double>& metrics);

/// Median, percentiles, maximum and share of each stage, or empty when frames.csv has no stage times.
std::string stage_table(const FrameTable& frames);

/// Version, seed, renderer, instruction set, hashes.
std::string provenance_table(const RunHeader& header);

/// CSS colour of a stage, the same in table and plot; index in the order of slam::Stage.
std::string stage_colour(size_t stage);

}  // namespace groundloop::bench
