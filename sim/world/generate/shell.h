#pragma once

#include "sim/world/generate/floor_plan.h"
#include "sim/world/generate/furniture.h"

namespace groundloop::sim {

/// Floor, ceiling, walls with their openings, skirting boards, lamps, and the light of the place.
void draw_shell(SceneWriter& scene, const FloorPlan& plan, const WorldRecipe& recipe, const Palette& palette,
                Dice& dice);

}  // namespace groundloop::sim
