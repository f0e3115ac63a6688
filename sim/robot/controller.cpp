#include "sim/robot/controller.h"

#include <algorithm>
#include <cmath>

namespace groundloop::sim {
namespace {

constexpr double kDamping = 0.8;
constexpr double kStiffness_per_m2 = 10;  ///< square of the natural frequency along the path
constexpr double kAngleGain_per_s = 12;   ///< how fast a wheel makes up for an angle it has fallen behind

}  // namespace

BodyTwist tracking_twist(const PlannedState& reference, const Pose2& T_world_body) {
  const double c = std::cos(T_world_body.yaw_rad), s = std::sin(T_world_body.yaw_rad);
  const double dx_m = reference.T_world_body.x_m - T_world_body.x_m;
  const double dy_m = reference.T_world_body.y_m - T_world_body.y_m;
  const double ahead_m = c * dx_m + s * dy_m;
  const double aside_m = -s * dx_m + c * dy_m;
  const double yaw_rad = wrapped(reference.T_world_body.yaw_rad - T_world_body.yaw_rad);
  const double sinc = std::abs(yaw_rad) < 1e-6 ? 1 : std::sin(yaw_rad) / yaw_rad;

  const auto& [v_mps, w_radps] = reference.twist;
  const double gain_per_s = 2 * kDamping * std::sqrt(w_radps * w_radps + kStiffness_per_m2 * v_mps * v_mps);
  return {v_mps * std::cos(yaw_rad) + gain_per_s * ahead_m,
          w_radps + kStiffness_per_m2 * v_mps * sinc * aside_m + gain_per_s * yaw_rad};
}

WheelController::WheelController(const DriveLimits& limits, double left_rad, double right_rad)
    : limits_(limits), left_{left_rad}, right_{right_rad} {}

WheelSpeeds WheelController::command(const BodyTwist& wanted, double left_rad, double right_rad,
                                     double step_s) {
  const double turn_mps = wanted.turn_rate_radps * limits_.track_m / 2;
  return {command(left_, (wanted.speed_mps - turn_mps) / limits_.wheel_radius_m, left_rad, step_s),
          command(right_, (wanted.speed_mps + turn_mps) / limits_.wheel_radius_m, right_rad, step_s)};
}

double WheelController::command(Wheel& wheel, double wanted_radps, double angle_rad, double step_s) const {
  const double behind_rad = wheel.angle_rad - angle_rad;
  const double change_radps = limits_.wheel_acceleration_radps2 * step_s;
  const double fastest_radps = limits_.wheel_speed_radps;
  wanted_radps = std::clamp(wanted_radps, wheel.speed_radps - change_radps, wheel.speed_radps + change_radps);
  wheel.speed_radps = std::clamp(wanted_radps, -fastest_radps, fastest_radps);
  wheel.angle_rad += wheel.speed_radps * step_s;
  return std::clamp(wheel.speed_radps + kAngleGain_per_s * behind_rad, -fastest_radps, fastest_radps);
}

}  // namespace groundloop::sim
