#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/arm/arm_model.h"
#include "sim/truth/scene_tree.h"
#include "sim/truth/solid.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// What an arm would touch: its links against the scene and against each other, exact shapes in Bullet. Links
/// that are joined do not count, nor does what the base stands on.
class ArmClearance {
 public:
  /// @param world, arm  must outlive this object
  ArmClearance(const World& world, const ArmModel& arm);

  /// The first touch with these joint angles, as "ur5e_forearm_tube touches east_box"; none when everything
  /// is at least margin_m clear.
  std::optional<std::string> touch(const JointAngles& q, double margin_m) const;

 private:
  struct Part {
    std::unique_ptr<Solid> solid;
    int geom;
    int link;  ///< 0 the base, 6 the hand
  };
  std::optional<std::string> touch_scene(const Part& part, const Support& body) const;
  std::string name_of(int geom) const;

  const World& world_;
  const ArmModel& arm_;
  std::vector<Part> parts_;
  SceneTree scene_;
  World::DataPtr scratch_;
};

}  // namespace groundloop::sim
