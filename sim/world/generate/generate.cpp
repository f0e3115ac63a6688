#include "sim/world/generate/generate.h"

#include <fmt/format.h>

#include "sim/world/generate/furnishing.h"
#include "sim/world/generate/shell.h"

namespace groundloop::sim {
namespace {

std::string name_of(WorldStyle style) {
  for (const auto& [value, name] : EnumNames<WorldStyle>::names) {
    if (value == style) return name;
  }
  return "";
}

}  // namespace

std::string generated_world(const WorldRecipe& recipe) {
  const uint64_t seed = recipe.seed.value();
  Dice plan_dice(seed, 1), palette_dice(seed, 2), shell_dice(seed, 3);
  const std::string style = name_of(recipe.style);
  SceneWriter scene(fmt::format("{}_{}", style, seed));
  const FloorPlan plan = make_floor_plan(recipe, plan_dice);
  const Palette palette(scene, palette_dice, recipe.style == WorldStyle::kLowTexture);
  draw_shell(scene, plan, recipe, palette, shell_dice);
  furnish(scene, plan, recipe.style, palette, seed);
  return scene.text(recipe.textures, fmt::format("A world of style {} from seed {}, {:.2f} m x {:.2f} m x {:.2f} m.",
                                                 style, seed, plan.width_m, plan.depth_m, plan.height_m));
}

}  // namespace groundloop::sim
