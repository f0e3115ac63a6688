#include "slam/tracking/perspective.h"

namespace groundloop::slam {

Eigen::Vector2f inverse_depth_slope(const AffineState& left, const AffineState& right, double disparity_px) {
  return (left.A.row(0) - right.A.row(0)).transpose() / static_cast<float>(disparity_px);
}

Eigen::Vector2f perspective_per_px(const StereoRig& rig, const Pose& T_left_first,
                                   const Eigen::Vector3d& p_left, const Eigen::Vector2f& slope_per_px) {
  const Eigen::Matrix3d R = T_left_first.linear();
  const Eigen::Vector3d t = T_left_first.translation();
  const double depth_first_m = R.col(2).dot(p_left - t);
  // z_left / z_first = R_3 ray + t_3 / z_first, with ray and 1 / z_first linear in x.
  const Eigen::Vector2d turned(R(2, 0) / rig.fx_px, R(2, 1) / rig.fy_px);
  const Eigen::Vector2d advanced = t.z() / depth_first_m * slope_per_px.cast<double>();
  return ((turned + advanced) * (depth_first_m / p_left.z())).cast<float>();
}

}  // namespace groundloop::slam
