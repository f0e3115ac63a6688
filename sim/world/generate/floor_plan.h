#pragma once

#include <string>
#include <vector>

#include "sim/scenario/recipe.h"
#include "sim/world/generate/dice.h"

namespace groundloop::sim {

/// An axis-aligned piece of floor, world frame [m].
struct Rect {
  double x_min_m = 0, y_min_m = 0, x_max_m = 0, y_max_m = 0;

  double width_m() const { return x_max_m - x_min_m; }
  double height_m() const { return y_max_m - y_min_m; }
  Rect grown(double by_m) const { return {x_min_m - by_m, y_min_m - by_m, x_max_m + by_m, y_max_m + by_m}; }
  bool overlaps(const Rect& other) const {
    return x_min_m < other.x_max_m && other.x_min_m < x_max_m && y_min_m < other.y_max_m &&
           other.y_min_m < y_max_m;
  }
  bool holds(const Rect& other) const {
    return x_min_m <= other.x_min_m && other.x_max_m <= x_max_m && y_min_m <= other.y_min_m &&
           other.y_max_m <= y_max_m;
  }
};

/// A way through a wall, along it.
struct Opening {
  double from_m = 0, to_m = 0;
};

/// One side of a room as seen by someone who stands before it: s runs along it to the right.
struct WallSide {
  size_t room = 0;
  double x_m = 0, y_m = 0;  ///< left end, on the wall's face
  double yaw_deg = 0;       ///< of a body that stands against it (its back to the wall): 0 on the north side
  double length_m = 0;
  bool outside = false;     ///< daylight behind it
  std::vector<Opening> openings;

  /// The floor that something between s = from and to, reaching `depth` into the room, takes.
  Rect floor(double from_m, double to_m, double depth_m) const;
  /// Where a body stands against the wall at s.
  double x_at(double s_m) const;
  double y_at(double s_m) const;
};

/// A wall between two rooms, along y.
struct Partition {
  double x_m = 0;          ///< of its middle
  double from_m = 0, to_m = 0;
  Opening opening;         ///< in y
};

/// Rooms in a row along x, with ways through the walls between them. The whole is centred at the origin.
struct FloorPlan {
  double width_m = 0, depth_m = 0, height_m = 0;  ///< x, y, z inside
  std::vector<Rect> rooms;
  std::vector<Partition> partitions;
  std::vector<WallSide> sides;
  std::vector<Rect> keep_clear;  ///< before and behind every opening
};

inline constexpr double kPartition_m = 0.12;  ///< thickness

FloorPlan make_floor_plan(const WorldRecipe& recipe, Dice& dice);

}  // namespace groundloop::sim
