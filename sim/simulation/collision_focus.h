#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world/world.h"

namespace groundloop::sim {

/// Speeds up collision detection in furnished rooms: MuJoCo 2.2 compares the static bodies of a world with
/// each other in every step, which takes more than ten times as long as everything else. This is a view of
/// the world's model in which static bodies out of the robot's reach have no geoms to compare; contacts are
/// the same.
class CollisionFocus {
 public:
  /// @param model  the world's, with its bodies where they are (SceneMotion); must outlive this object
  CollisionFocus(const World& world, const mjModel& model);
  CollisionFocus(const CollisionFocus&) = delete;
  CollisionFocus& operator=(const CollisionFocus&) = delete;

  /// The model to step with. Shares everything with the one given but the number of geoms of each body.
  const mjModel& model() const { return model_; }
  /// Notices what the robot has come near to; call before every step.
  void update(const mjData& state);
  /// Things stand elsewhere than at the last update: looks round again at the next.
  void look_again() { updated_ = false; }

 private:
  /// A geom that stands, as a ball around it.
  struct Obstacle {
    int geom;
    int body;
    double radius_m;  ///< infinite for planes and height fields
  };
  mjModel model_;
  int robot_body_;
  std::vector<int> colliding_geoms_;  ///< a body's geoms up to the last that can touch anything
  std::vector<int> geoms_in_use_;     ///< model_.body_geomnum
  std::vector<Obstacle> obstacles_;
  double robot_radius_m_ = 0;
  Eigen::Vector3d p_world_update_;
  bool updated_ = false;
};

}  // namespace groundloop::sim
