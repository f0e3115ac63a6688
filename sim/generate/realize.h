#pragma once

#include "sim/generate/texture_sight.h"
#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// What a scenario leaves to chance, drawn: seeds of recipes that have none become the scenario's; a generated plan
/// becomes a start and segments. The answer needs no generator but that of its world, and gives the same run
/// wherever it is loaded. A scenario without recipes stays as it is.
/// @param pictures  may be kept from scenario to scenario
/// @throws InputError when models cannot be loaded, or there is no such way
Scenario realized(Scenario scenario, PictureContrast& pictures);
Scenario realized(Scenario scenario);

}  // namespace groundloop::sim
