#include "slam/adjustment/observation_terms.h"

namespace groundloop::slam {
namespace {
constexpr double kMinDepth_m = 0.01;
}

bool observation_terms(const StereoRig& rig, const Pose& T_odom_left, const Eigen::Vector3d& p_odom,
                       const Eigen::Vector3d& uvu_px, double sigma_px, ObservationTerms& terms) {
  const Eigen::Matrix3d R_left_odom = T_odom_left.linear().transpose();
  const Eigen::Vector3d p = R_left_odom * (p_odom - T_odom_left.translation());
  if (!(p.z() >= kMinDepth_m)) {
    terms = ObservationTerms{};
    terms.s = kNotInView;
    return false;
  }
  // G = sqrt(W) d(uvu)/d(p_left) has the rows a (1, 0, -x), c (0, 1, -y), a (1, 0, -x_right).
  const double inverse_z = 1 / p.z(), inverse_sigma = 1 / sigma_px;
  const double x = p.x() * inverse_z, y = p.y() * inverse_z, x_right = (p.x() - rig.baseline_m) * inverse_z;
  const double a = rig.fx_px * inverse_z * inverse_sigma,
               c2 = 2 * rig.fy_px * rig.fy_px * inverse_z * inverse_z * inverse_sigma * inverse_sigma;
  const double r_left = (uvu_px.x() - (rig.fx_px * x + rig.cx_px)) * inverse_sigma;
  const double r_row = (uvu_px.y() - (rig.fy_px * y + rig.cy_px)) * inverse_sigma;
  const double r_right = (uvu_px.z() - (rig.fx_px * x_right + rig.cx_right_px)) * inverse_sigma;
  terms.s = r_left * r_left + 2 * r_row * r_row + r_right * r_right;

  Eigen::Matrix3d M;  // G^T G
  const double a2 = a * a;
  M << 2 * a2, 0, -a2 * (x + x_right),  //
      0, c2, -c2 * y,                   //
      -a2 * (x + x_right), -c2 * y, a2 * (x * x + x_right * x_right) + c2 * y * y;
  const double c_row = 2 * rig.fy_px * inverse_z * inverse_sigma * r_row;
  const Eigen::Vector3d g(a * (r_left + r_right), c_row, -a * (x * r_left + x_right * r_right) - y * c_row);

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

}  // namespace groundloop::slam
