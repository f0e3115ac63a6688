#pragma once

#include <vector>

#include "bench/report/footprint.h"
#include "sim/truth/truth_world.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// Heights between which the exact map is taken: above the floor, up to 2 m as the paper's.
inline constexpr double kBandMin_m = 0.02;
inline constexpr double kBandMax_m = 2.0;

/// The exact scene, standing as at the start.
sim::TruthWorld exact_scene(const sim::World& world);

/// Outlines of everything that reaches into the band.
std::vector<Footprint> scene_outline(const sim::TruthWorld& world);

}  // namespace groundloop::bench
