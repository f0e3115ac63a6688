#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "slam/types/pose.h"

namespace groundloop::bench {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;

inline slam::Pose turned(double angle_deg, const Eigen::Vector3d& axis) {
  return slam::Pose(Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis.normalized()));
}

inline slam::Pose moved(double x_m, double y_m, double z_m) {
  return slam::Pose(Eigen::Translation3d(x_m, y_m, z_m));
}

inline slam::StampedPose at(double time_s, const slam::Pose& T) {
  return {static_cast<int64_t>(std::llround(time_s * 1e9)), T};
}

/// Along x, one step a second.
inline slam::Trajectory straight(int poses, double step_m) {
  slam::Trajectory trajectory;
  for (int i = 0; i < poses; ++i) trajectory.push_back(at(i, moved(i * step_m, 0, 0)));
  return trajectory;
}

/// Counter-clockwise circle in the xy plane, heading along it; the last pose is one step before the first.
inline slam::Trajectory circle(int poses, double radius_m) {
  slam::Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    trajectory.push_back(at(i, turned(360.0 * i / poses, Eigen::Vector3d::UnitZ()) * moved(radius_m, 0, 0)));
  }
  return trajectory;
}

}  // namespace groundloop::bench
