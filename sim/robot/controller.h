#pragma once

#include "sim/robot/planned_path.h"
#include "sim/robot/pose2.h"

namespace groundloop::sim {

/// Left and right wheel [rad/s].
struct WheelSpeeds {
  double left_radps = 0;
  double right_radps = 0;
};

/// Twist that brings a unicycle back to its reference: the time-varying law with damping 0.8 and a natural
/// frequency of 3.2 per metre driven, so that corrections take the same way at any speed.
///   v = v_r cos e_yaw + k1 e_x,   w = w_r + k2 v_r (sin e_yaw / e_yaw) e_y + k3 e_yaw
/// with the error e in the robot's frame. On the spot (v_r = 0) heading and distance are corrected, sideways
/// is not.
/// @see Canudas de Wit, Khennouf, Samson, Sordalen 1993, after Kanayama et al. 1990
BodyTwist tracking_twist(const PlannedState& reference, const Pose2& T_world_body);

/// From a wanted twist to wheel servo inputs: keeps to the wheels' acceleration and speed, and corrects the
/// angle by which a wheel has fallen behind, as a motor controller with integral action does.
class WheelController {
 public:
  /// @param left_rad, right_rad  wheel angles at the start
  WheelController(const DriveLimits& limits, double left_rad, double right_rad);
  /// @param step_s  time since the last call
  WheelSpeeds command(const BodyTwist& wanted, double left_rad, double right_rad, double step_s);

 private:
  struct Wheel {
    double angle_rad;  ///< where the wheel should be
    double speed_radps = 0;
  };
  double command(Wheel& wheel, double wanted_radps, double angle_rad, double step_s) const;

  DriveLimits limits_;
  Wheel left_, right_;
};

}  // namespace groundloop::sim
