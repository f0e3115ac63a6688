#pragma once

#include <array>
#include <string>

#include "sim/arm/arm_kinematics.h"
#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// The arm of a world's robot file: six position servos in a chain with the lengths of the UR family, whose
/// root body stands; on its last body a site ..._flange and a site ..._camera (x right, y down, z along the
/// optical axis); `<custom><numeric>` ..._joint_speed_radps and ..._joint_acceleration_radps2.
struct ArmModel {
  struct Joint {
    int qpos, dof, actuator;
    double stiffness;  ///< of the servo [N m / rad]
    double damping;    ///< of the joint [N m s / rad]
  };
  std::array<Joint, 6> joints;
  std::array<int, 7> bodies;  ///< base, then the body that each joint turns
  ArmGeometry geometry;
  JointLimits limits;
  double joint_speed_radps = 0;
  double joint_acceleration_radps2 = 0;
  slam::Pose T_world_base = slam::Pose::Identity();
  slam::Pose T_flange_camera = slam::Pose::Identity();  ///< as believed: without hand-eye error

  JointAngles angles(const mjData& state) const;
  void set_angles(const JointAngles& q, mjData& state) const;
  /// Pose of the flange in a state whose kinematics are up to date.
  slam::Pose T_world_flange(const mjData& state) const;
};

/// @param robot_file  named in messages
/// @throws InputError naming what the robot lacks, all at once; also when it drives
ArmModel find_arm(const World& world, const std::string& robot_file);

}  // namespace groundloop::sim
