#pragma once

#include <cstdint>
#include <optional>

#include "sim/cache/content_key.h"
#include "sim/head/head.h"
#include "sim/render/renderer.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// What every pixel of a run depends on: the code that makes images (its sources, compiler, MuJoCo, OpenCV),
/// the renderer and the instruction set, the compiled model, its textures, the head, how images are made, the
/// seed.
/// @param world     the scenario's, with or without textures: these are told by their files
/// @param renderer  that makes the images
sim::KeyBuilder run_key(const sim::World& world, const sim::HeadModel& head, const sim::Scenario& scenario,
                        const sim::RendererInfo& renderer);

/// The key of the pair that the head delivers of one exposure, before the cable. Beside the run's: where
/// every geom and light is and how bright, both cameras, every moment of an exposure that takes time, the
/// lens' and light's faults in force, the exposure's number (its noise) and setting.
sim::ContentKey pair_key(const sim::KeyBuilder& run, const sim::World& world, const sim::Scenario& scenario,
                         const sim::Exposure& exposure, const std::optional<sim::ExposureSetting>& setting);

}  // namespace groundloop::bench
