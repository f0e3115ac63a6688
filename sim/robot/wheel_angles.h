#pragma once

#include <array>
#include <vector>

#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// What unequal wheels, slip and failing encoders do to the left and the right wheel at one time.
struct WheelFaults {
  std::array<double, 2> grip = {1, 1};     ///< way over the floor by way turned
  std::array<double, 2> counted = {1, 1};  ///< part of the counts that reaches the odometry
};
/// A wheel of another diameter than the robot takes it for is one that always slips, or skids, by that much.
WheelFaults wheel_faults(const DriveErrors& errors, const std::vector<Fault>& faults, double time_s);

/// Angles [rad] of the driven wheels (0 left, 1 right), as far as the robot knows them. In the physics wheels
/// roll and do not slip; a slipping wheel is one whose motor turns farther than it rolls. So slip has exactly
/// the stated ratio, whatever the load.
class WheelAngles {
 public:
  explicit WheelAngles(const std::array<double, 2>& rolled_rad) : rolled_rad_(rolled_rad) {}

  /// Takes in the angles rolled until now, with what was wrong since the last update.
  void update(const std::array<double, 2>& rolled_rad, const WheelFaults& faults);

  /// What the motor turned: what the servo controls, and its tachometer says.
  double motor_rad(size_t wheel) const { return rolled_rad_[wheel] + slipped_rad_[wheel]; }
  /// What the encoder counted.
  double counted_rad(size_t wheel) const { return motor_rad(wheel) - missed_rad_[wheel]; }

 private:
  std::array<double, 2> rolled_rad_;
  std::array<double, 2> slipped_rad_ = {};
  std::array<double, 2> missed_rad_ = {};
};

}  // namespace groundloop::sim
