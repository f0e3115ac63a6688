#pragma once

#include <Eigen/Core>

#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// d(point in the left camera) / d(u_left, v, u_right) [m/px], of StereoRig::triangulate.
/// @param uvu  (u_left, v, u_right) [px] with a disparity beyond that of infinity
Eigen::Matrix3d triangulation_jacobian(const StereoRig& rig, const Eigen::Vector3d& uvu);

/// Covariance of a triangulated point in the left camera [m^2], first order: independent noise of both
/// columns with standard deviation sigma_px, and of the row, which is the mean of both images' rows, with
/// variance sigma^2 / 2. The disparity then has the standard deviation sigma_px * sqrt(2).
/// @param uvu  (u_left, v, u_right) [px] with a disparity beyond that of infinity
Eigen::Matrix3d point_covariance(const StereoRig& rig, const Eigen::Vector3d& uvu, double sigma_px);

}  // namespace groundloop::slam
