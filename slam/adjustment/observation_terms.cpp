#include "slam/adjustment/observation_terms.h"

#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {
namespace {
constexpr double kMinDepth_m = 0.01;
}

bool observation_terms(const StereoRig& rig, const Pose& T_odom_left, const Eigen::Vector3d& p_odom,
                       const Eigen::Vector3d& uvu_px, const Eigen::Matrix3d& W, ObservationTerms& terms) {
  const Eigen::Matrix3d R_left_odom = T_odom_left.linear().transpose();
  const Eigen::Vector3d p = R_left_odom * (p_odom - T_odom_left.translation());
  if (!(p.z() >= kMinDepth_m)) {
    terms = ObservationTerms{};
    terms.s = kNotInView;
    return false;
  }
  const Eigen::Vector3d r = uvu_px - rig.project(p);
  const Eigen::Matrix3d G = projection_jacobian(rig, p);
  const Eigen::Matrix3d GtW = G.transpose() * W;
  terms.s = r.dot(W * r);
  const Eigen::Matrix3d M = GtW * G;
  const Eigen::Vector3d g = GtW * r;

  // d(p_left) = -v + p x w + R_left_odom dl for a twist (v, w) on the right of T_odom_left.
  const Eigen::Matrix3d N = M * R_left_odom, p_cross_M = M.colwise().cross(-p);
  terms.H_ll.noalias() = R_left_odom.transpose() * N;
  terms.H_xl.topRows<3>() = -N;
  terms.H_xl.bottomRows<3>() = N.colwise().cross(p);
  terms.H_xx.topLeftCorner<3, 3>() = M;
  terms.H_xx.topRightCorner<3, 3>() = p_cross_M.transpose();
  terms.H_xx.bottomLeftCorner<3, 3>() = p_cross_M;
  terms.H_xx.bottomRightCorner<3, 3>() = p_cross_M.transpose().colwise().cross(-p);
  terms.g_l.noalias() = R_left_odom.transpose() * g;
  terms.g_x.head<3>() = -g;
  terms.g_x.tail<3>() = -p.cross(g);
  return true;
}

Matrix36d moved_by_right_camera(const StereoRig& rig, const Eigen::Vector3d& p_left) {
  const Eigen::Vector3d p_right = p_left - Eigen::Vector3d(rig.baseline_m, 0, 0);
  const double inverse_z = 1 / p_right.z();
  Matrix36d d_p_right;  // d(p_right) = -v + p_right x w for a twist (v, w)
  d_p_right << -Eigen::Matrix3d::Identity(), skew(p_right);
  Matrix36d d_uvu;
  d_uvu.row(0).setZero();
  // The row is the mean of both images'.
  d_uvu.row(1) =
      0.5 * rig.fy_px * inverse_z * (d_p_right.row(1) - p_right.y() * inverse_z * d_p_right.row(2));
  d_uvu.row(2) = rig.fx_px * inverse_z * (d_p_right.row(0) - p_right.x() * inverse_z * d_p_right.row(2));
  return triangulation_jacobian(rig, rig.project(p_left)) * d_uvu;
}

}  // namespace groundloop::slam
