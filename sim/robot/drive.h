#pragma once

#include <string>
#include <string_view>

#include "sim/robot/planned_path.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// Where a differential drive's wheels are in the model: actuators named ...left_wheel and ...right_wheel on
/// hinge joints of the robot; a `<custom><numeric>` ...wheel_acceleration_radps2.
struct Drive {
  int left_actuator = -1;
  int right_actuator = -1;
  int left_qpos = -1;  ///< address of the wheel's angle
  int right_qpos = -1;
  DriveLimits limits;  ///< radius of the geoms that touch the floor, distance of the joints, actuator limits
};

/// The robot's actuator on a hinge joint whose name ends so, -1 when there is none.
int find_hinge_actuator(const World& world, std::string_view ending);
/// First value of the `<custom><numeric>` whose name ends so, 0 when there is none.
double find_numeric(const World& world, std::string_view ending);

/// @param robot_file  named in messages
/// @throws InputError naming what the robot lacks, all at once
Drive find_drive(const World& world, const std::string& robot_file);

}  // namespace groundloop::sim
