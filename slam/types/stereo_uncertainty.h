#pragma once

#include <Eigen/Core>

#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// d(u_left, v, u_right) / d(point in the left camera) [px/m], of StereoRig::project.
/// @param p_left  before the camera [m]
inline Eigen::Matrix3d projection_jacobian(const StereoRig& rig, const Eigen::Vector3d& p_left) {
  const double inverse_z = 1 / p_left.z(), inverse_z2 = inverse_z * inverse_z;
  Eigen::Matrix3d J;
  J << rig.fx_px * inverse_z, 0, -rig.fx_px * p_left.x() * inverse_z2,  //
      0, rig.fy_px * inverse_z, -rig.fy_px * p_left.y() * inverse_z2,   //
      rig.fx_px * inverse_z, 0, -rig.fx_px * (p_left.x() - rig.baseline_m) * inverse_z2;
  return J;
}

/// d(point in the left camera) / d(u_left, v, u_right) [m/px], of StereoRig::triangulate.
/// @param uvu  (u_left, v, u_right) [px] with a disparity beyond that of infinity
Eigen::Matrix3d triangulation_jacobian(const StereoRig& rig, const Eigen::Vector3d& uvu);

/// Cofactor of a measurement (u_left, v, u_right) whose four image coordinates err alike and independently:
/// its covariance relative to the variance of one coordinate. The row is the mean of two: diag(1, 1/2, 1).
inline Eigen::Matrix3d equal_cofactor() { return Eigen::Vector3d(1, 0.5, 1).asDiagonal(); }

/// Covariance of a triangulated point in the left camera [m^2], first order.
/// @param uvu  (u_left, v, u_right) [px] with a disparity beyond that of infinity
/// @param sigma_px  standard deviation of one image coordinate
/// @param cofactor  covariance of uvu relative to its square; with the equal one the disparity has the
/// standard deviation sigma_px * sqrt(2)
Eigen::Matrix3d point_covariance(const StereoRig& rig, const Eigen::Vector3d& uvu, double sigma_px,
                                 const Eigen::Matrix3d& cofactor = equal_cofactor());

}  // namespace groundloop::slam
