#include "sim/robot/pose2.h"

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

/// sin(x) / x
double sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

}  // namespace

Pose2 driven(const Pose2& from, double length_m, double turn_rad) {
  const double chord_m = length_m * sinc(turn_rad / 2);
  const double direction_rad = from.yaw_rad + turn_rad / 2;
  return {from.x_m + chord_m * std::cos(direction_rad), from.y_m + chord_m * std::sin(direction_rad),
          from.yaw_rad + turn_rad};
}

Pose2 composed(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.yaw_rad), s = std::sin(T_a_b.yaw_rad);
  return {T_a_b.x_m + c * T_b_c.x_m - s * T_b_c.y_m, T_a_b.y_m + s * T_b_c.x_m + c * T_b_c.y_m,
          T_a_b.yaw_rad + T_b_c.yaw_rad};
}

Pose2 inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.yaw_rad), s = std::sin(T_a_b.yaw_rad);
  return {-c * T_a_b.x_m - s * T_a_b.y_m, s * T_a_b.x_m - c * T_a_b.y_m, -T_a_b.yaw_rad};
}

slam::Pose to_pose(const Pose2& T_a_b) {
  slam::Pose T = slam::Pose::Identity();
  T.linear() = Eigen::AngleAxisd(T_a_b.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << T_a_b.x_m, T_a_b.y_m, 0;
  return T;
}

Pose2 to_pose2(const slam::Pose& T_a_b) {
  return {T_a_b.translation().x(), T_a_b.translation().y(), slam::yaw_rad(T_a_b.linear())};
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

}  // namespace groundloop::sim
