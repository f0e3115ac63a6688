#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "slam/types/config.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// A truth that knows only where one point of the robot is on the floor plane.
struct PlanarPoint {
  int64_t stamp_ns = 0;
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();  ///< [m]
};
using PointTruth = std::vector<PlanarPoint>;

/// Reads a point truth from a TUM file (columns: seconds x y, the others are not used).
/// @throws InputError as read_trajectory()
PointTruth read_point_truth(const std::string& file);

/// Where the tracked point sits on the camera, and how well the estimate then follows it.
struct PlanarFit {
  slam::Pose T_world_map = slam::Pose::Identity();
  Eigen::Vector3d p_left_point = Eigen::Vector3d::Zero();  ///< lever arm [m]
  double rmse_m = 0;  ///< planar distance between estimated and true point
  double max_m = 0;
  double height_rms_m = 0;  ///< of the estimated point over the plane z = 0
};

/// Fits T_world_map and the lever arm to a trajectory of the left camera; the scale stays fixed.
///   minimises  sum rho(dx) + rho(dy) + rho(0.2 z) + sum rho(0.02 lever)    over  q_i = T_world_map
///   T_map_left p_left_point with rho(r) = 2 a^2 (sqrt(1 + (r/a)^2) - 1), a = 0.05 m: soft L1, so that a few
///   bad truth points do no harm; the weights hold the point near the plane and the lever arm short where the
///   path leaves them open.
/// The truth is interpolated at the estimate's stamps (beyond its ends: its first and last point).
/// @return none with fewer than three poses or an empty truth
std::optional<PlanarFit> fit_planar(const PointTruth& truth, const slam::Trajectory& T_map_left);

/// trajectory.planar_rmse_m and trajectory.planar_max_m.
Metrics planar_metrics(const PlanarFit& fit);

}  // namespace groundloop::bench
