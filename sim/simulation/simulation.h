#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "sim/head/head.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// The state of the world at one exposure, with its truth.
struct Exposure {
  int64_t index = 0;
  int64_t stamp_ns = 0;
  slam::Pose T_world_body;     ///< true pose of the robot's body frame
  slam::Pose T_world_left;     ///< true pose of the left camera
  slam::Pose T_world_right;
  slam::Pose T_odom_body;      ///< wheel odometry (with its errors) since the start, planar
  slam::Pose T_plan_body;      ///< where the plan says the robot is, world frame
  slam::Pose T_previous_left;  ///< planned motion of the left camera since the last exposure (what the core may know)
  World::DataPtr state{nullptr, mj_deleteData};  ///< MuJoCo state to render
};

/// Physics, controller and odometry: drives the plan and stops at every exposure.
class Simulation {
 public:
  /// @throws InputError when the plan runs into something (names segment, place and geom) or the models do not fit
  Simulation(const World& world, const HeadModel& head, const Scenario& scenario);
  ~Simulation();

  /// Advances to the next exposure; none when the plan is driven.
  std::optional<Exposure> advance();
  /// Exposures of the whole plan.
  int64_t exposures() const;
  /// Length of the planned path [m].
  double planned_length_m() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
