#include <fmt/format.h>

#include "sim/world/generate/furniture.h"

namespace groundloop::sim {
namespace {

Vec3 tinted(Dice& dice, double low, double high, double colour) {
  const double level = dice.uniform(low, high);
  return {level * dice.uniform(1 - colour, 1), level * dice.uniform(1 - colour, 1),
          level * dice.uniform(1 - colour, 1)};
}

std::string boxy(SceneWriter& scene, Dice& dice, const char* texture, double colour) {
  Finish finish;
  finish.texture = texture;
  finish.cube = true;
  finish.rgb = tinted(dice, 0.75, 1, colour);
  return scene.material(finish);
}

std::string flat(SceneWriter& scene, Dice& dice, const char* texture, double repeat_x, double repeat_y) {
  Finish finish;
  finish.texture = texture;
  finish.repeat_x = repeat_x;
  finish.repeat_y = repeat_y;
  finish.rgb = tinted(dice, 0.8, 1, 0.08);
  return scene.material(finish);
}

std::string colour(SceneWriter& scene, const Vec3& rgb) {
  Finish finish;
  finish.rgb = rgb;
  return scene.material(finish);
}

}  // namespace

Palette::Palette(SceneWriter& scene, Dice& dice, bool plain_) : plain(plain_) {
  const Vec3 pale = tinted(dice, 0.62, 0.8, 0.1);
  const char* timber = dice.chance(0.6) ? "light_wood" : "dark_wood";
  top = plain ? colour(scene, pale)
              : flat(scene, dice, dice.chance(0.7) ? timber : "grey_laminate", dice.uniform(1.5, 3), 1);
  wood = plain ? colour(scene, pale) : boxy(scene, dice, timber, 0.1);
  metal = plain ? colour(scene, tinted(dice, 0.45, 0.7, 0.1))
                : boxy(scene, dice, dice.chance(0.5) ? "brushed_metal" : "painted_metal", 0.15);
  back = plain ? wood : flat(scene, dice, dice.chance(0.5) ? "dark_wood" : "grey_laminate", 2, 1);
  fabric = plain ? colour(scene, tinted(dice, 0.3, 0.55, 0.4)) : boxy(scene, dice, "fabric", 0.2);
  frame = plain ? colour(scene, tinted(dice, 0.4, 0.7, 0.1)) : boxy(scene, dice, "painted_metal", 0.2);
  black = colour(scene, {0.12, 0.12, 0.13});
  chrome = colour(scene, {0.62, 0.64, 0.66});
  white = colour(scene, {0.78, 0.78, 0.76});
  paper = colour(scene, {0.72, 0.70, 0.64});
  covers = {colour(scene, {0.62, 0.20, 0.16}), colour(scene, {0.18, 0.30, 0.52}),
            colour(scene, {0.22, 0.44, 0.28}), colour(scene, {0.46, 0.46, 0.48})};
  if (plain) {
    cartons = {colour(scene, {0.60, 0.50, 0.36})};
  } else {
    for (const char* texture : {"cardboard_1", "cardboard_2"}) {
      for (int shade = 0; shade < 2; ++shade) cartons.push_back(boxy(scene, dice, texture, 0.1));
    }
  }
}

std::string picture(SceneWriter& scene, Dice& dice, const std::string& texture, double smallest,
                    double emission) {
  Finish finish;
  finish.texture = texture;
  // Few levels, so that not every picture is a material of its own.
  const int dimmed = dice.integer(0, 3);
  finish.rgb = {1 - 0.08 * dimmed, 1 - 0.07 * dice.integer(0, 2), 1 - 0.07 * dice.integer(0, 2)};
  finish.emission = emission;
  finish.repeat_x = smallest + (1 - smallest) * dice.integer(0, 4) / 4;
  finish.repeat_y = smallest + (1 - smallest) * dice.integer(0, 4) / 4;
  return scene.material(finish);
}

std::string numbered(Dice& dice, const std::string& stem, int count) {
  return fmt::format("{}_{}", stem, dice.integer(1, count));
}

}  // namespace groundloop::sim
