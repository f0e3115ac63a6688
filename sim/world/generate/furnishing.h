#pragma once

#include "sim/world/generate/floor_plan.h"
#include "sim/world/generate/furniture.h"

namespace groundloop::sim {

/// Puts furniture along the walls and in islands between them, and pictures on what is left of the walls. Aisles
/// round every island, and ways to every opening, stay clear.
void furnish(SceneWriter& scene, const FloorPlan& plan, WorldStyle style, const Palette& palette, uint64_t seed);

}  // namespace groundloop::sim
