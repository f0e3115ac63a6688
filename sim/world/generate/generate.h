#pragma once

#include <string>

#include "sim/scenario/recipe.h"

namespace groundloop::sim {

/// A furnished building as MJCF text, made from models/textures' pictures and the seed alone: the same recipe
/// gives the same bytes on every machine. Every geom is a primitive, everything is static, floor at z = 0.
/// Openings are at least 1.1 m wide and aisles at least 1.15 m; rooms narrower than 2 m are left empty.
/// @param recipe  with a seed; size_m is empty or two numbers (WorldRecipe::check)
std::string generated_world(const WorldRecipe& recipe);

}  // namespace groundloop::sim
