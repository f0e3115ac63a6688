#include "slam/types/pose.h"

#include <Eigen/SVD>
#include <cmath>

namespace groundloop::slam {
namespace {

/// Left Jacobian of SO(3): takes the translational part of a twist to the translation of its exponential.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_rad) {
  const double angle2 = rotation_rad.squaredNorm();
  const Eigen::Matrix3d K = skew(rotation_rad);
  double b, c;
  if (angle2 < 1e-8) {
    b = 0.5 - angle2 / 24, c = 1.0 / 6 - angle2 / 120;
  } else {
    const double angle = std::sqrt(angle2);
    b = (1 - std::cos(angle)) / angle2, c = (angle - std::sin(angle)) / (angle2 * angle);
  }
  return Eigen::Matrix3d::Identity() + b * K + c * K * K;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad) {
  const double angle2 = rotation_rad.squaredNorm();
  const Eigen::Matrix3d K = skew(rotation_rad);
  if (angle2 < 1e-8) {
    return Eigen::Matrix3d::Identity() + (1 - angle2 / 6) * K + (0.5 - angle2 / 24) * K * K;
  }
  const double angle = std::sqrt(angle2);
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * K + (1 - std::cos(angle)) / angle2 * K * K;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& R_a_b) {
  Eigen::Quaterniond q(R_a_b);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2 * q.vec();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

Pose se3_exp(const Vector6d& twist) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp(twist.tail<3>());
  T.translation() = left_jacobian(twist.tail<3>()) * twist.head<3>();
  return T;
}

Vector6d se3_log(const Pose& T_a_b) {
  Vector6d twist;
  twist.tail<3>() = so3_log(T_a_b.linear());
  twist.head<3>() = left_jacobian(twist.tail<3>()).partialPivLu().solve(T_a_b.translation());
  return twist;
}

double rotation_angle_rad(const Eigen::Matrix3d& R_a_b) { return so3_log(R_a_b).norm(); }

double yaw_rad(const Eigen::Matrix3d& R_a_b) { return std::atan2(R_a_b(1, 0), R_a_b(0, 0)); }

Pose renormalised(const Pose& T_a_b) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(T_a_b.linear(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose T = T_a_b;
  Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  T.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return T;
}

}  // namespace groundloop::slam
