#pragma once

#include <string>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::bench {

/// Everything wrong with a scenario: the file itself, the options of the core, head, world and robot models,
/// and a planned path that runs into something. What can be looked at in spite of other problems is. Empty:
/// it can be run.
std::vector<Problem> problems_of_scenario(const std::string& file);

}  // namespace groundloop::bench
