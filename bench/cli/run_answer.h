#pragma once

#include <vector>

#include "bench/cli/progress.h"
#include "bench/runner/run.h"

namespace groundloop::bench {

// What the commands that run something have in common.

/// Prints what came out of each run, as lines or as JSON.
/// @param seeded  false for a recording, which has no seed
/// @return the exit code, that of the worst run
int report(const std::vector<RunOutcome>& runs, bool seeded, bool json);

/// Progress goes to the terminal, Ctrl-C stops.
/// @param progress  must outlive the job
JobControl control_with(Progress& progress);

}  // namespace groundloop::bench
