#pragma once

#include <cstdint>
#include <string>

#include "sim/arm/arm_model.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// The arm stands when every joint is so near to where it should be, and turns no faster.
inline constexpr double kSettled_rad = 2e-6;
inline constexpr double kStill_radps = 2e-5;
/// Longest time it may take for that after a motion.
inline constexpr double kSettleLimit_s = 1;

/// What it usually takes.
inline constexpr double kUsualRest_s = 0.25;

/// Moves an arm's joints by its position servos, in MuJoCo's physics. The servos are fed forward with
/// gravity, inertia and damping, as an arm's own controller does, so that they lag and sag by nothing that
/// stays. Nothing collides: the plan was checked.
class ArmServo {
 public:
  /// Starts at rest. @param world, arm  must outlive this object
  ArmServo(const World& world, const ArmModel& arm, const JointAngles& start);

  /// Time from rest to rest for joints that turn by `way`.
  /// @param least_s  do not run faster than in this time, on average, for a limit on the hand's speed
  static double duration_s(const ArmModel& arm, const JointAngles& way, double least_s);

  /// Runs all joints together to q in that time, and waits until they stand.
  /// @return false when they do not stand within kSettleLimit_s after the motion
  bool move_to(const JointAngles& q, double least_s);

  double time_s() const { return state_->time; }
  const mjData& state() const { return *state_; }
  /// Where the joint that is farthest off is, as "joint 3 is 0.12 deg off and turns at 0.5 deg/s".
  std::string unrest(const JointAngles& q) const;

 private:
  struct Wanted {
    JointAngles q, rate, acceleration;
  };
  void step(const Wanted& wanted);
  bool stands_at(const JointAngles& q) const;

  const ArmModel& arm_;
  mjModel model_;  ///< the world's without contacts; shares its arrays
  World::DataPtr state_;
  JointAngles q_;                                     ///< last wanted
  std::vector<mjtNum> acceleration_, inertia_force_;  ///< of all degrees of freedom
};

}  // namespace groundloop::sim
