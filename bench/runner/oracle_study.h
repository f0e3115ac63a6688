#pragma once

#include <string>
#include <vector>

#include "bench/runner/run.h"

namespace groundloop::bench {

/// `groundloop oracles`: one scenario as it is, and again with the work of single stages replaced by exact
/// answers, so that each stage's part of the error shows.
///
/// Every run leaves its folder below that of the study (OUT/as_it_is, OUT/exact_tracking, ...); the first
/// one's report gets the table (oracles.json).
/// @return as it is; then exact tracking, stereo, tracking and stereo, motion, loops
/// @throws InputError, Interrupted
std::vector<RunOutcome> oracle_study(const OracleStudyOptions& options, const JobControl& control);

/// The metrics that a study compares, in the order of its columns.
const std::vector<std::string>& study_metrics();

}  // namespace groundloop::bench
