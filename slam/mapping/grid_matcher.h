#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "slam/mapping/map_match_options.h"
#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// A pose in the plane and what is known of it.
struct PlanarPose {
  Eigen::Isometry2d T_global_local = Eigen::Isometry2d::Identity();
  /// Right perturbation (x, y, yaw) in `local`: T_global_local exp(d).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Where the local map lies in the global one, or why that cannot be said.
struct MapMatch {
  bool accepted = false;
  std::string message = "not run";  ///< reason of refusal
  /// Measured from the maps alone: what was known before sets the window of the search only. Filled in as far
  /// as a match got; the covariance of a refused one tells which direction is open.
  PlanarPose pose;
  double score = 0;         ///< of the best place, relative to the local map laid over itself
  double second_score = 0;  ///< of the second best separate peak, relative to the best; 0: below half of it
  double overlap = 0;       ///< share of the local map's occupied cells where the global map knows something
  double agreement = 0;     ///< share of those that are occupied there, too
  int cells = 0;            ///< occupied cells of the local map
};

/// Registers the local map to the global one: correlative search over the whole window, then the summit of
/// the smooth score by Newton's method, then the covariance from the shape of the score around it (Olson,
/// ICRA 2009). The best place is refused as not enough structure when the maps do not fix all three of x, y
/// and heading: too few cells, little overlap, a long straight wall, a repeated pattern.
/// @param global  must not hold the evidence of which the local map is made, or it matches itself
/// @param local   in a frame of its own near the robot, such as that of its newest key frame's body
/// @param prior   where trajectory and odometry put the local frame, sets the search window
MapMatch match_maps(const OccupancyMap& global, const OccupancyMap& local, const PlanarPose& prior,
                    const MapMatchOptions& options);

}  // namespace groundloop::slam
