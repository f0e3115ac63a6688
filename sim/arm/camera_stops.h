#pragma once

#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// One planned stop: where the left image is to be taken.
struct CameraStop {
  slam::Pose T_world_left = slam::Pose::Identity();
  int64_t first_pair = 0;  ///< number of its first pair; it stays until the next stop's
  std::string key;         ///< "plan.poses[3]", or "plan.path (stop 3)", for messages
  int line = 0;
};

/// Pose of a camera at a place that looks along yaw and tilt, its x axis level and to the right.
slam::Pose level_look(const Eigen::Vector3d& p_world, double yaw_rad, double tilt_rad);

/// The stops of an arm's plan, one after the other, at the scenario's scale. Along a path, consecutive stops
/// are as far apart as step_m and step_deg allow, evenly within each piece.
/// @param period_ns  from pair to pair
/// @throws InputError when at_s does not rise by a period or more, or names no pair's time
std::vector<CameraStop> camera_stops(const Scenario& scenario, int64_t period_ns);

}  // namespace groundloop::sim
