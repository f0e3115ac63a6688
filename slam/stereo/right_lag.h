#pragma once

#include <Eigen/Core>

#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// What it does to a pair when its right camera exposes late (or early) while the head moves: the right image
/// shows every point where the flow has carried it by then. Without lag, and at rest, nothing.
class RightLag {
 public:
  RightLag() = default;
  /// @param velocity  of the left camera in its own axes, at the time of the left image [m/s, rad/s]
  /// @param late_s    right exposure after the left one; negative: before it
  RightLag(const Vector6d& velocity, double late_s)
      : velocity_(velocity), late_s_(late_s), T_late_left_(se3_exp(-late_s * velocity)) {}

  bool none() const { return late_s_ == 0; }

  /// Left camera as the left image is taken, in that of the right image's time.
  const Pose& T_late_left() const { return T_late_left_; }

  /// How fast a point that stands still moves down the right image as that is taken [px/s].
  /// @param p_left  in the left camera when the left image was taken [m]; zero where it is not in front
  double row_flow_px_per_s(const StereoRig& rig, const Eigen::Vector3d& p_left) const;

  /// From where the point would be in a right image taken in time to where it is in this one [px].
  /// @param p_left  in the left camera when the left image was taken [m]; zero where it is not in front
  Eigen::Vector2f shift_px(const StereoRig& rig, const Eigen::Vector3d& p_left) const;

  /// The same of a new match, whose point has to be found with it.
  /// @param left_px, right_px  where it is in the two images, lag included
  Eigen::Vector2f shift_px(const StereoRig& rig, const Eigen::Vector2f& left_px,
                           const Eigen::Vector2f& right_px) const;

 private:
  Vector6d velocity_ = Vector6d::Zero();
  double late_s_ = 0;
  Pose T_late_left_ = Pose::Identity();
};

}  // namespace groundloop::slam
