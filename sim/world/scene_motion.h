#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "sim/world/walk.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// Where people and moved furniture are at any time. Both are bodies without joints; what changes is where
/// the model says they stand, in arrays of its own.
class SceneMotion {
 public:
  /// Everything stands as at time 0.
  /// @param world  must outlive this object
  /// @throws InputError when a move names no body, one that has joints, one of the robot, or one that stands
  /// on something that is moved itself
  SceneMotion(const World& world, const Scenario& scenario);
  SceneMotion(const SceneMotion&) = delete;
  SceneMotion& operator=(const SceneMotion&) = delete;

  /// The world's model, with everything where it is at the time last placed. Shares the other arrays.
  const mjModel& model() const { return model_; }
  /// Puts everything where it is at a time. True when a piece of furniture stands elsewhere than before.
  bool place(double time_s);
  /// False when nothing ever moves but the robot.
  bool anything_moves() const { return !people_.empty() || !moves_.empty(); }

 private:
  struct Limb {
    int body;
    double sign;     ///< of the swing
    double rest[4];  ///< orientation at rest
  };
  struct Walker {
    int body;
    double hip_m;  ///< length of the legs; 0 without
    Walk walk;
    std::vector<Limb> limbs;
  };
  struct Placed {
    int body;
    double at_s;
    double pos[3], quat[4];  ///< in its parent
  };
  Walker walker_of(const Person& person) const;
  void put(const Walker& walker, double time_s);
  Placed placed(const Move& move, const mjData& at_start) const;
  void check_moves(const Scenario& scenario) const;
  int body_named(const std::string& name) const;

  const World& world_;
  mjModel model_;
  std::vector<mjtNum> body_pos_, body_quat_;
  std::vector<Walker> people_;
  std::vector<Placed> moves_;  ///< in the order of their times
  size_t moves_done_ = 0;
};

}  // namespace groundloop::sim
