#pragma once

#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "slam/pipeline/options.h"

namespace groundloop::bench {

/// Options of the core: the scenario's preset, its lengths times `slam.scale`, with its `set` on top; then
/// all lengths times the scenario's scale. The scenario's seed goes into the core's.
/// @throws InputError naming file, line, option, value and what was wanted
slam::SlamOptions slam_options(const sim::Scenario& scenario);

/// The same of a preset named on a command line, with `--set` options of the core.
slam::SlamOptions slam_options(const std::string& preset, const std::vector<sim::Override>& set);

}  // namespace groundloop::bench
