#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "sim/truth/scene_tree.h"

namespace groundloop::sim {

/// The robot as an obstacle test sees it: the footprint of every geom of its body tree at qpos0, swept from
/// just above the floor to the top of the robot.
class RobotFootprint {
 public:
  RobotFootprint(const mjModel& model, int robot_body);

  /// First scene geom nearer than margin_m to the footprint at this body pose, or null. Bullet's GJK on exact
  /// support functions.
  const SceneGeom* collision(const SceneTree& scene, double x_m, double y_m, double yaw_rad,
                             double margin_m) const;

  /// Of the circle about the body's origin that holds the footprint.
  double radius_m() const { return radius_m_; }

 private:
  struct Part {
    std::unique_ptr<Solid> solid;
    slam::Pose T_body_geom = slam::Pose::Identity();
  };
  std::vector<Part> parts_;
  double z_min_m_ = 0;  ///< world heights of the sweep
  double z_max_m_ = 0;
  double radius_m_ = 0;
};

}  // namespace groundloop::sim
