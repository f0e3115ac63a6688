#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/generate/free_space.h"
#include "sim/scenario/recipe.h"

namespace groundloop::sim {

/// Whether there is enough to see from it, looked at only where a route wants to go.
enum class Sight { kUnknown, kEnough, kTooLittle };

/// From one straight way into the next: an arc that touches both, where the corner between them was.
struct Turn {
  int to = 0;  ///< the next way
  double radius_m = 0;
  double angle_rad = 0;    ///< positive to the left
  double tangent_m = 0;    ///< what the arc takes of either way
  double cost = 0;
  Sight sight = Sight::kUnknown;
};

/// A straight way between two points, in one direction.
struct Way {
  int from = 0, to = 0;  ///< points
  double length_m = 0;
  double yaw_rad = 0;
  double cost = 0;
  Sight sight = Sight::kUnknown;
  std::vector<Turn> turns;
};

/// Random points of the free space, the straight ways between them, and every arc by which one way can follow
/// another: whatever is driven on it is smooth and clear by construction. A probabilistic road map (Kavraki et
/// al. 1996) of directed ways, so that curvature is bounded.
struct Roadmap {
  Roadmap(const FreeSpace& space, const PlanRecipe& recipe, uint64_t seed);

  std::vector<Eigen::Vector2d> points;
  std::vector<Way> ways;
  std::vector<std::vector<int>> ways_from;  ///< by point

 private:
  void scatter_points(const FreeSpace& space, uint64_t seed);
  void join_points(const FreeSpace& space, uint64_t seed);
  void find_turns(const FreeSpace& space, double min_radius_m);
};

}  // namespace groundloop::sim
