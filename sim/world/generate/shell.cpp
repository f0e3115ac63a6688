#include "sim/world/generate/shell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kWall_m = 0.1;  ///< thickness of outer walls; they stand outside of the rooms
constexpr double kDoorHeight_m = 2.1;
constexpr double kSkirting_m = 0.045;  ///< half height

FloorKind floor_kind(const WorldRecipe& recipe, Dice& dice) {
  const int drawn = dice.integer(0, 3);
  if (recipe.floor != FloorKind::kAny) return recipe.floor;
  if (recipe.style == WorldStyle::kLowTexture && drawn == 3)
    return FloorKind::kWood;  // something must be seen
  constexpr FloorKind kKinds[] = {FloorKind::kTiles, FloorKind::kCarpet, FloorKind::kWood,
                                  FloorKind::kConcrete};
  return kKinds[drawn];
}

std::string floor_material(SceneWriter& scene, const WorldRecipe& recipe, FloorKind floor, Dice& dice) {
  struct Kind {
    const char* texture;
    double per_metre, darkest, lightest, shiniest;
  };
  const auto kind = [floor]() -> Kind {
    switch (floor) {
      case FloorKind::kCarpet:
        return {"carpet", 0.8, 0.8, 1, 0};
      case FloorKind::kWood:
        return {"light_wood", 0.5, 0.7, 0.95, 0.2};
      case FloorKind::kConcrete:
        return {"painted_metal", 0.7, 0.6, 0.8, 0.15};
      default:
        return {"floor_tiles", 0.55, 0.8, 1, 0.3};
    }
  }();
  Finish finish;
  finish.texture = kind.texture;
  finish.uniform = true;
  finish.repeat_x = finish.repeat_y = kind.per_metre * dice.uniform(0.8, 1.2);
  const double level = dice.uniform(kind.darkest, kind.lightest);
  finish.rgb = {level, level * dice.uniform(0.93, 1), level * dice.uniform(0.88, 1)};
  const double shine = std::max(0.0, dice.uniform(-0.5, 1) * kind.shiniest);  // a third of them is dull
  finish.reflectance = recipe.reflectance.value_or(shine);
  return scene.material(finish);
}

/// A corridor is walls and floor: where its floor shows nothing, its walls must.
std::string wall_material(SceneWriter& scene, const WorldRecipe& recipe, FloorKind floor, Dice& dice) {
  Finish finish;
  const bool must_show = recipe.style == WorldStyle::kCorridor && floor == FloorKind::kConcrete;
  const bool plaster = (dice.chance(0.5) && !must_show) || recipe.style == WorldStyle::kLowTexture;
  finish.texture = plaster ? "plain_plaster" : "painted_blocks";
  finish.uniform = true;
  finish.repeat_x = finish.repeat_y = (plaster ? 0.4 : 0.625) * dice.uniform(0.85, 1.15);
  const double level = dice.uniform(0.8, 1);
  finish.rgb = {level, level * dice.uniform(0.92, 1), level * dice.uniform(0.86, 1)};
  return scene.material(finish);
}

std::string ceiling_material(SceneWriter& scene, Dice& dice) {
  Finish finish;
  finish.texture = "ceiling_tiles";
  finish.uniform = true;
  finish.repeat_x = finish.repeat_y = 0.8333 * dice.uniform(0.9, 1.1);
  return scene.material(finish);
}

/// Light from four sides, from above and back from the floor, as in models/worlds/lab.xml: no face is dark,
/// none looks like its neighbour. The whole is turned by the seed.
void draw_lights(SceneWriter& scene, Dice& dice) {
  const double turn = dice.uniform(0, 2 * std::numbers::pi), strength = dice.uniform(0.85, 1.1);
  const auto light = [&](double x, double y, double z, double grey, bool shadow) {
    scene.light({std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, z},
                grey * strength, shadow);
  };
  scene.set_ambient(dice.uniform(0.34, 0.42));
  light(0.25, 0.9, -0.55, 0.27, false);
  light(0, 0, -1, 0.34, true);
  light(0.8, 0.1, -0.25, 0.24, false);
  light(-0.85, -0.1, 0.1, 0.18, false);
  light(-0.1, -0.9, 0.2, 0.15, false);
  light(0.1, -0.15, 1, 0.22, false);
}

void draw_skirting(SceneWriter& scene, const WallSide& side, const std::string& material) {
  const auto board = [&](double from, double to) {
    scene.box(material, {(to - from) / 2, 0.0075, kSkirting_m},
              {(from + to) / 2 - side.length_m / 2, -0.0075, kSkirting_m});
  };
  double from = 0;
  for (const Opening& way : side.openings) {
    board(from, way.from_m - 0.05);
    from = way.to_m + 0.05;
  }
  board(from, side.length_m);
}

void draw_partition(SceneWriter& scene, const Partition& wall, size_t index, double height_m,
                    const std::string& material, const Palette& palette) {
  scene.begin_body(fmt::format("partition_{}", index + 1), wall.x_m, 0, 90);  // x is to the world's y
  const double half = kPartition_m / 2;
  const auto piece = [&](double from, double to, double low, double high) {
    scene.panel(material, {(to - from) / 2, (high - low) / 2, half}, {(from + to) / 2, 0, (low + high) / 2});
  };
  const Opening& way = wall.opening;
  piece(wall.from_m, way.from_m, 0, height_m);
  piece(way.to_m, wall.to_m, 0, height_m);
  piece(way.from_m, way.to_m, kDoorHeight_m, height_m);
  for (const double y : {way.from_m + 0.005, way.to_m - 0.005}) {
    scene.box(palette.frame, {0.045, half + 0.02, kDoorHeight_m / 2}, {y, 0, kDoorHeight_m / 2});
  }
  scene.box(palette.frame, {(way.to_m - way.from_m) / 2 - 0.05, half + 0.02, 0.045},
            {(way.from_m + way.to_m) / 2, 0, kDoorHeight_m + 0.005});
  scene.end_body();
}

void draw_lamps(SceneWriter& scene, const FloorPlan& plan, Dice& dice) {
  Finish finish;
  finish.rgb = {0.95, 0.95, 0.92};
  finish.emission = 1;
  const std::string lamp = scene.material(finish);
  const bool square = dice.chance(0.4);
  const double pitch = dice.uniform(2.2, 3.2), half_x = square ? 0.3 : 0.6, half_y = square ? 0.3 : 0.15;
  scene.begin_body("lamps", 0, 0, 0);
  for (const Rect& room : plan.rooms) {
    const int nx = std::max(1, static_cast<int>(room.width_m() / pitch));
    const int ny = std::max(1, static_cast<int>(room.height_m() / pitch));
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        scene.decor(lamp, {half_x, half_y, 0.025},
                    {room.x_min_m + (i + 0.5) * room.width_m() / nx,
                     room.y_min_m + (j + 0.5) * room.height_m() / ny, plan.height_m - 0.0249});
      }
    }
  }
  scene.end_body();
}

}  // namespace

void draw_shell(SceneWriter& scene, const FloorPlan& plan, const WorldRecipe& recipe, const Palette& palette,
                Dice& dice) {
  draw_lights(scene, dice);
  const double half_x = plan.width_m / 2 + kWall_m, half_y = plan.depth_m / 2 + kWall_m;
  const FloorKind floor = floor_kind(recipe, dice);
  scene.floor(floor_material(scene, recipe, floor, dice), half_x, half_y, 0, 0);
  scene.box(ceiling_material(scene, dice), {half_x, half_y, 0.05}, {0, 0, plan.height_m + 0.05});

  const std::string common = wall_material(scene, recipe, floor, dice),
                    other = wall_material(scene, recipe, floor, dice);
  Finish dark;
  dark.rgb = {0.30, 0.28, 0.26};
  const std::string skirting = scene.material(dark);
  for (size_t i = 0; i < plan.sides.size(); ++i) {
    const WallSide& side = plan.sides[i];
    scene.begin_body(fmt::format("wall_{}", i + 1), side.x_at(side.length_m / 2),
                     side.y_at(side.length_m / 2), side.yaw_deg);
    if (side.outside) {
      scene.panel(dice.chance(0.7) ? common : other,
                  {side.length_m / 2 + kWall_m, plan.height_m / 2, kWall_m / 2},
                  {0, kWall_m / 2, plan.height_m / 2});
    }
    draw_skirting(scene, side, skirting);
    scene.end_body();
  }
  for (size_t i = 0; i < plan.partitions.size(); ++i) {
    draw_partition(scene, plan.partitions[i], i, plan.height_m, dice.chance(0.5) ? common : other, palette);
  }
  draw_lamps(scene, plan, dice);
}

}  // namespace groundloop::sim
