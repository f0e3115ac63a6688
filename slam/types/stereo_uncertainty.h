#pragma once

#include <Eigen/Core>

#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

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
