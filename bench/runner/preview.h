#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// Model of the scene as it stands at the start and the planned trajectory from above (the paper's Fig. 5),
/// with people's ways, furniture that is moved and kidnappings; BGR.
cv::Mat preview_picture(const sim::World& world, const sim::Scenario& scenario,
                        const sim::Simulation& simulation);

/// `groundloop preview`: writes the picture of a scenario as PNG.
/// @param file  where to; empty: NAME.png in the current folder
/// @return the file written
/// @throws InputError when the scenario cannot be run, or the file not be written
std::string preview(const sim::Scenario& scenario, const std::string& file);

}  // namespace groundloop::bench
