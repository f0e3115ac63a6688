#pragma once

#include <Eigen/Core>

#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

using Matrix63d = Eigen::Matrix<double, 6, 3>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

/// What one observation adds to the normal equations, before its robust weight. With J_x, J_l the derivatives
/// of the projection by the twist x of T_odom_left exp(x) and by the landmark l in odom, W the information of
/// (u_left, v, u_right), and r = measured - projected:
struct ObservationTerms {
  double s = 0;                                    ///< r^T W r: squared misfit in standard deviations
  Matrix6d H_xx = Matrix6d::Zero();                ///< J_x^T W J_x
  Matrix63d H_xl = Matrix63d::Zero();              ///< J_x^T W J_l
  Eigen::Matrix3d H_ll = Eigen::Matrix3d::Zero();  ///< J_l^T W J_l
  Vector6d g_x = Vector6d::Zero();                 ///< J_x^T W r
  Eigen::Vector3d g_l = Eigen::Vector3d::Zero();   ///< J_l^T W r
};

/// Squared misfit given to a landmark that is not before the camera: so large that it has no weight.
constexpr double kNotInView = 1e6;

/// @param W  inverse covariance of uvu_px
/// @return false, s = kNotInView and zeros when the landmark is less than 1 cm before the camera
bool observation_terms(const StereoRig& rig, const Pose& T_odom_left, const Eigen::Vector3d& p_odom,
                       const Eigen::Vector3d& uvu_px, const Eigen::Matrix3d& W, ObservationTerms& terms);

/// How the point of a pair moves that its images triangulate to, when the right camera stands elsewhere than
/// beside the left one: derivative of the point in the left camera [m] by the right camera's twist,
/// translation [m] first, on its right.
/// @param p_left  before both cameras [m]
Matrix36d moved_by_right_camera(const StereoRig& rig, const Eigen::Vector3d& p_left);

}  // namespace groundloop::slam
