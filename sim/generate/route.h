#pragma once

#include <vector>

#include "sim/generate/roadmap.h"
#include "sim/generate/texture_sight.h"

namespace groundloop::sim {

/// A drivable way: where it starts, and what is driven from there.
struct Route {
  StartPose start;
  std::vector<Segment> segments;
};

/// Draws a way from a seed: legs to one random place after another, each the cheapest on a road map that avoids
/// what was driven already; closed by a last leg into the first way when laps are asked for. Ways from which too
/// little texture is seen are left out.
/// @param scenario  its plan has a recipe with a seed; names file and key in messages
/// @throws InputError when the world has no such way
Route make_route(const Scenario& scenario, const TruthWorld& truth, const TextureSight& sight);

}  // namespace groundloop::sim
