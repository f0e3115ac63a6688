#include "sim/world/generate/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kDoorRoom_m = 1.3;  ///< kept clear on either side of an opening
constexpr double kSmallestRoom_m = 3.5;

/// Size of the whole when the recipe leaves it to the seed.
std::vector<double> drawn_size(WorldStyle style, Dice& dice) {
  switch (style) {
    case WorldStyle::kCorridor:
      return {dice.uniform(18, 32), dice.uniform(2.5, 3.2)};
    case WorldStyle::kDoorway:
      return {dice.uniform(10, 16), dice.uniform(5, 8)};
    default:
      return {dice.uniform(8, 15), dice.uniform(6, 10)};
  }
}

void add_partitions(FloorPlan& plan, Dice& dice) {
  const int most = std::min(3, static_cast<int>(plan.width_m / kSmallestRoom_m));
  const int rooms = std::max(2, dice.integer(2, std::max(2, most)));
  const double pitch = plan.width_m / rooms, slack = std::max(0.0, (pitch - kSmallestRoom_m) / 2);
  for (int i = 1; i < rooms; ++i) {
    Partition wall;
    wall.x_m = -plan.width_m / 2 + i * pitch + dice.uniform(-slack, slack);
    wall.from_m = -plan.depth_m / 2;
    wall.to_m = plan.depth_m / 2;
    const double half = dice.uniform(0.55, 0.75);
    const double reach = plan.depth_m / 2 - half - 0.6;
    const double y = dice.uniform(-reach, reach);
    wall.opening = {y - half, y + half};
    plan.partitions.push_back(wall);
    plan.keep_clear.push_back({wall.x_m - kDoorRoom_m, y - half - 0.15, wall.x_m + kDoorRoom_m, y + half + 0.15});
  }
}

void add_rooms(FloorPlan& plan) {
  double from = -plan.width_m / 2;
  for (const Partition& wall : plan.partitions) {
    plan.rooms.push_back({from, -plan.depth_m / 2, wall.x_m - kPartition_m / 2, plan.depth_m / 2});
    from = wall.x_m + kPartition_m / 2;
  }
  plan.rooms.push_back({from, -plan.depth_m / 2, plan.width_m / 2, plan.depth_m / 2});
}

/// The four sides of every room; right of someone facing the wall is along (cos yaw, sin yaw).
void add_sides(FloorPlan& plan) {
  for (size_t i = 0; i < plan.rooms.size(); ++i) {
    const Rect& r = plan.rooms[i];
    WallSide north{i, r.x_min_m, r.y_max_m, 0, r.width_m(), true, {}};
    WallSide south{i, r.x_max_m, r.y_min_m, 180, r.width_m(), true, {}};
    WallSide west{i, r.x_min_m, r.y_min_m, 90, r.height_m(), i == 0, {}};
    WallSide east{i, r.x_max_m, r.y_max_m, -90, r.height_m(), i + 1 == plan.rooms.size(), {}};
    if (!west.outside) {
      const Opening& way = plan.partitions[i - 1].opening;
      west.openings.push_back({way.from_m - r.y_min_m, way.to_m - r.y_min_m});
    }
    if (!east.outside) {
      const Opening& way = plan.partitions[i].opening;
      east.openings.push_back({r.y_max_m - way.to_m, r.y_max_m - way.from_m});
    }
    plan.sides.insert(plan.sides.end(), {north, south, west, east});
  }
}

}  // namespace

double WallSide::x_at(double s_m) const { return x_m + s_m * std::cos(yaw_deg * std::numbers::pi / 180); }
double WallSide::y_at(double s_m) const { return y_m + s_m * std::sin(yaw_deg * std::numbers::pi / 180); }

Rect WallSide::floor(double from_m, double to_m, double depth_m) const {
  const double yaw_rad = yaw_deg * std::numbers::pi / 180;
  const double into_x = depth_m * std::sin(yaw_rad), into_y = -depth_m * std::cos(yaw_rad);
  const double x0 = x_at(from_m), y0 = y_at(from_m), x1 = x_at(to_m) + into_x, y1 = y_at(to_m) + into_y;
  return {std::min(x0, x1), std::min(y0, y1), std::max(x0, x1), std::max(y0, y1)};
}

FloorPlan make_floor_plan(const WorldRecipe& recipe, Dice& dice) {
  FloorPlan plan;
  const std::vector<double> drawn = drawn_size(recipe.style, dice);
  const std::vector<double>& size = recipe.size_m.empty() ? drawn : recipe.size_m;
  plan.width_m = size[0];
  plan.depth_m = size[1];
  plan.height_m = dice.uniform(2.6, 3.3);
  if (recipe.style == WorldStyle::kDoorway) add_partitions(plan, dice);
  add_rooms(plan);
  add_sides(plan);
  return plan;
}

}  // namespace groundloop::sim
