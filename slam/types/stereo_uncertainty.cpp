#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {

Eigen::Matrix3d triangulation_jacobian(const StereoRig& rig, const Eigen::Vector3d& uvu) {
  const double disparity_px = uvu.x() - uvu.z() - rig.disparity_at_infinity_px();
  const double z = rig.fx_px * rig.baseline_m / disparity_px;
  const double dz_m_px = -z / disparity_px;  // by u_left; by u_right it is the opposite
  const double x_n = (uvu.x() - rig.cx_px) / rig.fx_px;
  const double y_n = (uvu.y() - rig.cy_px) / rig.fy_px;
  Eigen::Matrix3d J;
  J << x_n * dz_m_px + z / rig.fx_px, 0, -x_n * dz_m_px,  //
      y_n * dz_m_px, z / rig.fy_px, -y_n * dz_m_px,       //
      dz_m_px, 0, -dz_m_px;
  return J;
}

Eigen::Matrix3d point_covariance(const StereoRig& rig, const Eigen::Vector3d& uvu, double sigma_px,
                                 const Eigen::Matrix3d& cofactor) {
  const Eigen::Matrix3d J = triangulation_jacobian(rig, uvu);
  return sigma_px * sigma_px * (J * cofactor * J.transpose());
}

}  // namespace groundloop::slam
