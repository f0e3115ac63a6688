#pragma once

#include "sim/head/head.h"
#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// The head of a scenario as its robot carries it. On an arm the mount is given by the plan: the body is a
/// frame that goes with the camera, x axis along its look direction, on the plane z = 0 of the world; at the
/// first stop it is below the left camera. Lengths are at the scenario's scale.
/// @throws InputError
HeadModel carried_head(const Scenario& scenario);

}  // namespace groundloop::sim
