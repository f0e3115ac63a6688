#pragma once

#include <string>
#include <vector>

#include "sim/world/mjcf.h"

namespace groundloop::sim {

/// Puts a robot into a world: one MJCF tree in which both keep their meaning.
///  - `<default>` classes of either file apply to its own elements only (they are renamed world/...,
///  robot/...);
///  - the robot's `<compiler>` units hold; angles of the world are converted;
///  - gravity, wind, magnetic field and medium come from the world, solver settings from the robot;
///  - `<visual>` and `<statistic>` come from the world; key frames of both are dropped (the scenario places
///  the robot).
///  - people (read_person) come as they are, with MuJoCo's own defaults.
/// @throws InputError: a name used in both files, or settings that cannot both hold
MjcfElement compose_mjcf(MjcfElement world, MjcfElement robot, std::vector<MjcfElement> people = {});

/// The body of a robot file that has a free joint, or, when none has, the one that stands in the world and
/// carries joints: the base of an arm. Gets the name "robot" when it has none.
/// @throws InputError when there is none, or more than one
std::string robot_root_body(MjcfElement& robot);

}  // namespace groundloop::sim
