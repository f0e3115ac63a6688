#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace groundloop::bench {

/// Outline of one thing of the scene seen from above, in the world frame [m]; closed by itself.
struct Footprint {
  std::string name;
  std::vector<Eigen::Vector2d> polygon;
};

/// A position and heading on the floor.
struct PlanPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;  ///< about z, 0 along x
};

}  // namespace groundloop::bench
