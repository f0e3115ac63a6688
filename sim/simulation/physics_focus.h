#pragma once

#include <Eigen/Core>
#include <memory_resource>
#include <vector>

#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// Steps the physics of a furnished room almost as fast as that of an empty one. In every step, MuJoCo 2.2
/// computes where each body and geom of the world is, and compares static bodies with each other: for a
/// laboratory many times the work for the robot itself. What is stepped here is a smaller model: everything
/// that moves, and of what stands only what can be touched and is in the robot's reach. It keeps MuJoCo's
/// order, so all motion is the same to the last bit.
///
/// A model that refers to bodies by number (excluded contacts, equalities, sites that act) keeps all its
/// bodies, and one that refers to geoms (pairs, tendons) is stepped whole, as is one in which anything but
/// the robot moves.
class PhysicsFocus {
 public:
  /// @param model  the world's, with its bodies where they are (SceneMotion); must outlive this object
  PhysicsFocus(const World& world, const mjModel& model);
  PhysicsFocus(const PhysicsFocus&) = delete;
  PhysicsFocus& operator=(const PhysicsFocus&) = delete;

  /// One step from a state of the whole model under its controls. It moves on in time, coordinates,
  /// velocities and activations; where bodies and geoms are by then, mj_kinematics says to whom it concerns.
  void step(mjData& state);
  /// Things stand elsewhere than at the last step.
  void look_again() { looked_ = false; }

  /// What the last step was made with. Bodies and geoms have numbers of their own.
  const mjModel& model() const { return near_; }

 private:
  /// A geom that stands, in a box of its own axes.
  struct Obstacle {
    int geom;
    Eigen::Vector3d half_size_m;  ///< infinite for planes and height fields
    slam::Pose T_geom_world;
  };
  void look_round(const Eigen::Vector3d& p_world_robot);
  std::vector<bool> kept_bodies() const;
  void reduce();

  const mjModel& whole_;
  mjModel near_;
  std::pmr::monotonic_buffer_resource near_rows_;  ///< of near_: its arrays of bodies and geoms
  World::DataPtr near_state_;                      ///< with room for the whole model
  const int robot_body_;
  const bool all_geoms_, all_bodies_;  ///< keep their numbers
  std::vector<bool> geom_is_near_;
  std::vector<Obstacle> obstacles_;
  double robot_radius_m_ = 0;
  Eigen::Vector3d p_world_looked_;
  bool looked_ = false;
};

}  // namespace groundloop::sim
