#pragma once

#include <vector>

#include "sim/robot/pose2.h"
#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// What a differential drive can do.
struct DriveLimits {
  double wheel_radius_m = 0;
  double track_m = 0;
  double wheel_speed_radps = 0;
  double wheel_acceleration_radps2 = 0;
};

/// Speed along the path and turn rate, positive to the left.
struct BodyTwist {
  double speed_mps = 0;
  double turn_rate_radps = 0;
};

/// Where the head looks, from straight ahead.
struct HeadAngles {
  double pan_rad = 0;   ///< positive to the left
  double tilt_rad = 0;  ///< positive up
};

/// Progress from 0 to 1 from rest to rest: rises with `rate_limit` at most, and `acceleration` [1/s, 1/s^2].
class SpeedRamp {
 public:
  SpeedRamp(double rate_limit, double acceleration);
  double duration_s() const { return 2 * ramp_s_ + cruise_s_; }
  double progress(double time_s) const;  ///< in [0, 1]
  double rate(double time_s) const;      ///< d progress / dt

 private:
  double rate_, acceleration_, ramp_s_, cruise_s_;
};

struct PlannedState {
  Pose2 T_world_body;
  BodyTwist twist;
  size_t segment = 0;
  double fraction = 0;  ///< of the segment driven, 0 to 1
  HeadAngles head = {};
  HeadAngles head_rate = {};  ///< d head / dt [rad/s]
};

/// The plan as a pose for every time, in closed form. Every segment starts and ends at rest, with a
/// trapezoidal speed between: where the curvature jumps, wheel speeds may not, so the robot stops there.
/// Speeds keep to the plan's and to what the wheels can do. While the head turns the robot stands; then it
/// drives on with the head turned, until told otherwise.
class PlannedPath {
 public:
  /// @param look_acceleration_radps2  of the head; needed when the plan looks
  PlannedPath(const StartPose& start, const Plan& plan, const DriveLimits& limits,
              double look_acceleration_radps2 = 1);

  double duration_s() const { return duration_s_; }
  double length_m() const { return length_m_; }  ///< of the body origin's way
  size_t segments() const { return pieces_.size(); }
  double segment_length_m(size_t segment) const;  ///< signed
  double segment_turn_rad(size_t segment) const;

  /// Pose and velocity; before the start and after the end the robot stands.
  PlannedState at(double time_s) const;
  /// Pose when a fraction (0 to 1) of a segment is driven.
  Pose2 at_fraction(size_t segment, double fraction) const;

 private:
  struct Piece {
    Pose2 T_world_start;
    double length_m;
    double turn_rad;
    double start_s;
    double duration_s;
    SpeedRamp ramp;
    HeadAngles head_start, head_end;
  };
  std::vector<Piece> pieces_;
  Pose2 T_world_end_;
  HeadAngles head_end_;
  double duration_s_ = 0;
  double length_m_ = 0;
};

}  // namespace groundloop::sim
