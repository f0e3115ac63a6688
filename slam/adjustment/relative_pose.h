#pragma once

#include "slam/types/pose.h"

namespace groundloop::slam {

/// Takes a twist at b to the same motion's twist at a: T_a_b exp(x) = exp(Ad x) T_a_b. Order: translation,
/// rotation.
Matrix6d se3_adjoint(const Pose& T_a_b);

/// d log(exp(twist) exp(x)) / dx at x = 0: inverse of the right Jacobian of SE(3), exact for rotations up to
/// pi. It is the value of (y / 2) coth(y / 2) + y / 2 at y = ad(twist); the even part is a polynomial of
/// degree four in ad(twist), because ad (ad^2 + angle^2)^2 = 0.
Matrix6d se3_right_jacobian_inverse(const Vector6d& twist);

/// Misfit of a measured relative pose, and how it changes with both ends.
struct RelativePoseError {
  Vector6d error;         ///< log(T_from_to_measured^-1 T_odom_from^-1 T_odom_to), a twist in `to`
  Matrix6d J_from, J_to;  /// d error / d twist, with T_odom_x exp(twist): perturbations on the right
};

/// @param T_from_to  as measured
RelativePoseError relative_pose_error(const Pose& T_odom_from, const Pose& T_odom_to, const Pose& T_from_to);

/// Covariance of T_a_b = T_odom_a^-1 T_odom_b from the joint covariance of both, all as twists on the right.
/// @param S_aa, S_ab, S_bb  blocks of the joint covariance
Matrix6d relative_pose_covariance(const Pose& T_a_b, const Matrix6d& S_aa, const Matrix6d& S_ab,
                                  const Matrix6d& S_bb);

}  // namespace groundloop::slam
