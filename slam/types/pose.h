#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace groundloop::slam {

/// Rigid motion. `T_a_b` takes points from b to a: p_a = T_a_b * p_b (docs/notation.md).
using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;  ///< twist: translation first [m], then rotation vector [rad]
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// SE(3) exponential of a twist (translation [m], rotation vector [rad]); exact, series near zero.
Pose se3_exp(const Vector6d& twist);

/// Inverse of se3_exp; the rotation angle is in [0, pi].
Vector6d se3_log(const Pose& T_a_b);

/// Rotation matrix of a rotation vector [rad] (Rodrigues).
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad);

/// Rotation vector [rad] of a rotation matrix; the angle is in [0, pi].
Eigen::Vector3d so3_log(const Eigen::Matrix3d& R_a_b);

/// Cross-product matrix: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation angle of R, in [0, pi] rad.
double rotation_angle_rad(const Eigen::Matrix3d& R_a_b);

/// Heading about the vertical z axis, in (-pi, pi] rad.
double yaw_rad(const Eigen::Matrix3d& R_a_b);

/// Nearest rotation (SVD), for chains of products that have drifted off the manifold.
Pose renormalised(const Pose& T_a_b);

struct StampedPose {
  int64_t stamp_ns = 0;
  Pose T = Pose::Identity();
};
using Trajectory = std::vector<StampedPose>;

}  // namespace groundloop::slam
