#pragma once

#include <string>
#include <vector>

#include "bench/runner/run.h"

namespace groundloop::bench {

/// What only several seeds of a scenario can tell, a line each: whether the covariances are honest, that is
/// whether the mean NEES over all seeds lies within its 95 % bounds. Empty for single runs.
std::string seed_summary(const std::vector<RunOutcome>& runs);

}  // namespace groundloop::bench
