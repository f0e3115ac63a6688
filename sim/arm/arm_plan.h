#pragma once

#include <array>
#include <vector>

#include "sim/arm/arm_model.h"
#include "sim/arm/camera_stops.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// Kept by every link from everything, at every stop and on every way between; times the scenario's scale.
inline constexpr double kArmClearance_m = 0.005;

/// Which image of a pair.
enum Side { kLeft = 0, kRight = 1 };

/// Where an arm goes: for every stop the joint angles of its left and its right image.
struct ArmPlan {
  std::vector<CameraStop> stops;
  std::vector<std::array<JointAngles, 2>> q;  ///< by stop, then Side

  /// Where the camera is meant to be, one baseline to the right for the right image.
  static slam::Pose T_world_camera(const CameraStop& stop, Side side, double baseline_m);
};

/// Joint angles for every stop: of up to eight postures at each, the sequence that turns the joints least and
/// touches nothing. From stop to stop, left to right to left, the joints run together along a straight line.
/// @throws InputError naming every stop that is out of reach (and by how much), every stop where something is
///         touched whatever the posture, and every way between two stops on which something is
ArmPlan plan_arm(const Scenario& scenario, const World& world, const ArmModel& arm, double baseline_m,
                 int64_t period_ns);

}  // namespace groundloop::sim
