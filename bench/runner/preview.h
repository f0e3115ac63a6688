#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "bench/runner/exact_scene.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/truth/truth_world.h"

namespace groundloop::bench {

/// Model of the scene and the planned trajectory from above (the paper's Fig. 5), BGR.
cv::Mat preview_picture(const sim::TruthWorld& world, const MapBand& band, const sim::Simulation& simulation);

/// `groundloop preview`: writes the picture of a scenario as PNG.
/// @param file  where to; empty: NAME.png in the current folder
/// @return the file written
/// @throws InputError when the scenario cannot be run, or the file not be written
std::string preview(const sim::Scenario& scenario, const std::string& file);

}  // namespace groundloop::bench
