#include "sim/simulation/collision_focus.h"

#include <algorithm>
#include <limits>

namespace groundloop::sim {
namespace {

constexpr double kReach_m = 0.15;  ///< beyond the robot's own radius
constexpr double kUpdate_m = 0.1;  ///< way after which to look round again; less than the reach

bool can_touch(const mjModel& model, int geom) {
  return (model.geom_contype[geom] | model.geom_conaffinity[geom]) != 0;
}

Eigen::Vector3d position(const mjtNum* xyz) { return Eigen::Map<const Eigen::Vector3d>(xyz); }

}  // namespace

CollisionFocus::CollisionFocus(const World& world, const mjModel& model)
    : model_(model), robot_body_(world.robot_body()), colliding_geoms_(static_cast<size_t>(model_.nbody)) {
  const World::DataPtr state = world.make_data();
  bool robot_moves_alone = true;
  for (int geom = 0; geom < model_.ngeom; ++geom) {
    if (!can_touch(model_, geom)) continue;
    const int body = model_.geom_bodyid[geom];
    colliding_geoms_[static_cast<size_t>(body)] = geom - model_.body_geomadr[body] + 1;

    const Eigen::Vector3d p_world = position(state->geom_xpos + 3 * geom);
    const double radius_m = model_.geom_rbound[geom];
    if (world.is_robot_geom(geom)) {
      const double reach_m = (p_world - position(state->xpos + 3 * robot_body_)).norm() + radius_m;
      robot_radius_m_ = std::max(robot_radius_m_, reach_m);
    } else if (model_.body_weldid[body] == 0) {
      obstacles_.push_back({geom, body, radius_m > 0 ? radius_m : std::numeric_limits<double>::infinity()});
    } else {
      robot_moves_alone = false;
    }
  }
  geoms_in_use_ = colliding_geoms_;
  model_.body_geomnum = geoms_in_use_.data();
  if (!robot_moves_alone) obstacles_.clear();  // other things that move may touch anything, anywhere
}

void CollisionFocus::update(const mjData& state) {
  const Eigen::Vector3d p_world_robot =
      position(state.qpos + model_.jnt_qposadr[model_.body_jntadr[robot_body_]]);
  if (updated_ && (p_world_robot - p_world_update_).norm() < kUpdate_m) return;
  p_world_update_ = p_world_robot;
  updated_ = true;

  for (const Obstacle& obstacle : obstacles_) geoms_in_use_[static_cast<size_t>(obstacle.body)] = 0;
  for (const Obstacle& obstacle : obstacles_) {
    const Eigen::Vector3d p_world = position(state.geom_xpos + 3 * obstacle.geom);
    const double gap_m = (p_world - p_world_robot).norm() - obstacle.radius_m - robot_radius_m_;
    const auto body = static_cast<size_t>(obstacle.body);
    if (gap_m < kReach_m) geoms_in_use_[body] = colliding_geoms_[body];
  }
}

}  // namespace groundloop::sim
