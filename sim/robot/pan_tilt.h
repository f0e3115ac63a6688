#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "sim/robot/planned_path.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// The robot's pan-tilt head: position servos named ..._pan and ..._tilt on hinge joints of the robot, with
/// the stereo head on the body of the tilt joint, and a `<custom><numeric>` ..._look_acceleration_radps2.
class PanTilt {
 public:
  /// @param T_body_left  where the left camera is with the head straight ahead
  /// @return none when the robot has no such servos
  /// @throws InputError when it has only part of a pan-tilt head
  static std::optional<PanTilt> find(const World& world, const std::string& robot_file,
                                     const slam::Pose& T_body_left);

  double acceleration_radps2() const { return acceleration_radps2_; }
  /// Travel of the joints.
  HeadAngles lowest() const { return {joints_[0].low_rad, joints_[1].low_rad}; }
  HeadAngles highest() const { return {joints_[0].high_rad, joints_[1].high_rad}; }

  /// Where the left camera would be with the head turned so.
  slam::Pose T_body_left(const HeadAngles& head) const;
  /// Where it is, in a state whose kinematics are up to date.
  slam::Pose T_world_left(const mjData& state) const;
  /// Sets the servos' inputs. The joints' damping is made up for ahead, so that a steady turn has no lag.
  void steer(const PlannedState& planned, mjData& state) const;

 private:
  struct Joint {
    int actuator, qpos;
    double low_rad, high_rad;
    double lead_s;  ///< damping over stiffness
  };
  PanTilt(const World& world, const std::array<int, 2>& actuators, double acceleration_radps2);
  slam::Pose T_body_tilt(const HeadAngles& head) const;

  const World* world_;
  std::array<Joint, 2> joints_;  ///< pan, tilt
  int tilt_body_;
  double acceleration_radps2_;
  slam::Pose T_tilt_left_;
  std::shared_ptr<mjData> scratch_;
};

/// @throws InputError naming every look of the plan that the robot cannot do
void check_looks(const Scenario& scenario, const std::optional<PanTilt>& head);

}  // namespace groundloop::sim
