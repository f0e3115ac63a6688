#pragma once

#include <cstdint>
#include <vector>

#include "sim/robot/pose2.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// Puts the robot elsewhere when its faults say so: the whole robot at once, at its height and tilt, with its
/// wheels turning on. It does not know: its plan goes on from there.
class Kidnapping {
 public:
  Kidnapping(const World& world, const std::vector<Fault>& faults);

  /// Carries out what is due up to a time.
  void update(int64_t time_ns, mjData& state);

  /// Where the plan's world is by now: a planned pose P is meant to be at T_world_plan P.
  const Pose2& T_world_plan() const { return T_world_plan_; }

 private:
  void put_down(const KidnapFault& there, mjData& state);

  struct Event {
    int64_t at_ns;
    KidnapFault there;
  };
  const World& world_;
  std::vector<Event> events_;  ///< still to come, the next one last
  Pose2 T_world_plan_;
};

/// Where a pose is after a kidnapping that puts the robot from one place to another.
Pose2 carried(const Pose2& T_world_from, const Pose2& T_world_to, const Pose2& T_world_pose);

Pose2 pose_of(const KidnapFault& kidnap);

/// The kidnappings among the faults, in order of time.
std::vector<Fault> kidnappings_of(const std::vector<Fault>& faults);

}  // namespace groundloop::sim
