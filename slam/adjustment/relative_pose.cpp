#include "slam/adjustment/relative_pose.h"

#include <cmath>

namespace groundloop::slam {
namespace {

/// ad(x) y = [x, y], the Lie bracket.
Matrix6d small_adjoint(const Vector6d& twist) {
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = skew(twist.tail<3>());
  ad.topRightCorner<3, 3>() = skew(twist.head<3>());
  return ad;
}

}  // namespace

Matrix6d se3_adjoint(const Pose& T_a_b) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = Ad.bottomRightCorner<3, 3>() = T_a_b.linear();
  Ad.topRightCorner<3, 3>() = skew(T_a_b.translation()) * T_a_b.linear();
  return Ad;
}

Matrix6d se3_right_jacobian_inverse(const Vector6d& twist) {
  // p(y) = 1 + a y^2 + b y^4 equals g(y) = (y / 2) coth(y / 2) in value and slope at y = +-i angle, the
  // double eigenvalues of ad(twist), and in value at 0.
  const double angle2 = twist.tail<3>().squaredNorm();
  double a, b;
  if (angle2 < 1e-2) {
    a = 1.0 / 12 - angle2 * angle2 / 30240, b = -1.0 / 720 - angle2 / 15120;
  } else {
    const double half = 0.5 * std::sqrt(angle2), sine = std::sin(half);
    const double g = half * std::cos(half) / sine;
    const double slope = 0.5 * g - 0.5 * half * half / (sine * sine);  // angle^2 dg / d(angle^2)
    a = (2 * (1 - g) + slope) / angle2;
    b = (1 - g + slope) / (angle2 * angle2);
  }
  const Matrix6d ad = small_adjoint(twist), ad2 = ad * ad;
  return Matrix6d::Identity() + 0.5 * ad + a * ad2 + b * ad2 * ad2;
}

RelativePoseError relative_pose_error(const Pose& T_odom_from, const Pose& T_odom_to, const Pose& T_from_to) {
  RelativePoseError out;
  const Pose T_to_from = T_odom_to.inverse() * T_odom_from;
  out.error = se3_log(T_from_to.inverse() * T_to_from.inverse());
  out.J_to = se3_right_jacobian_inverse(out.error);
  out.J_from.noalias() = -out.J_to * se3_adjoint(T_to_from);
  return out;
}

Matrix6d relative_pose_covariance(const Pose& T_a_b, const Matrix6d& S_aa, const Matrix6d& S_ab,
                                  const Matrix6d& S_bb) {
  const Matrix6d Ad = se3_adjoint(T_a_b.inverse());
  const Matrix6d cross = Ad * S_ab;
  return S_bb - cross - cross.transpose() + Ad * S_aa * Ad.transpose();
}

}  // namespace groundloop::slam
