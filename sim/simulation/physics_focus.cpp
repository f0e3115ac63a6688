#include "sim/simulation/physics_focus.h"

#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <limits>
#include <string_view>

namespace groundloop::sim {
namespace {

constexpr double kReach_m = 0.15;  ///< beyond the robot's own radius
constexpr double kUpdate_m = 0.1;  ///< way after which to look round again; less than the reach

/// Whether a geom is anything to the physics: it can be touched, or a fluid acts on it.
bool has_effect(const mjModel& model, int geom) {
  return (model.geom_contype[geom] | model.geom_conaffinity[geom]) != 0 ||
         model.geom_fluid[mjNFLUID * geom] > 0;
}

bool stands(const mjModel& model, int body) { return model.body_weldid[body] == 0; }

/// Whether things other than the robot move, which may touch anything anywhere.
bool others_move(const World& world, const mjModel& model) {
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (stands(model, model.geom_bodyid[geom]) || world.is_robot_geom(geom)) continue;
    if (has_effect(model, geom)) return true;
  }
  return false;
}

bool refers_to_geoms(const mjModel& model) { return model.npair > 0 || model.ntendon > 0; }

bool refers_to_bodies(const mjModel& model) {
  const bool acts_on_joints =
      std::all_of(model.actuator_trntype, model.actuator_trntype + model.nu,
                  [](int type) { return type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT; });
  return model.nexclude > 0 || model.neq > 0 || !acts_on_joints;
}

Eigen::Vector3d position(const mjtNum* xyz) { return Eigen::Map<const Eigen::Vector3d>(xyz); }

slam::Pose T_geom_world(const mjData& state, int geom) {
  slam::Pose T_world_geom = slam::Pose::Identity();
  T_world_geom.linear() =
      Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(state.geom_xmat + 9 * geom);
  T_world_geom.translation() = position(state.geom_xpos + 3 * geom);
  return T_world_geom.inverse();
}

/// A box round a geom and the margin at which MuJoCo takes it for touched.
Eigen::Vector3d half_size_m(const mjModel& model, int geom) {
  Eigen::Vector3d size_m = position(model.geom_size + 3 * geom);
  const auto box = [&]() -> Eigen::Vector3d {
    switch (model.geom_type[geom]) {
      case mjGEOM_PLANE:
      case mjGEOM_HFIELD:
        return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
      case mjGEOM_BOX:
      case mjGEOM_ELLIPSOID:
        return size_m;
      case mjGEOM_CYLINDER:
        return {size_m.x(), size_m.x(), size_m.y()};
      case mjGEOM_CAPSULE:
        return {size_m.x(), size_m.x(), size_m.y() + size_m.x()};
      default:
        return Eigen::Vector3d::Constant(model.geom_rbound[geom]);
    }
  };
  return box().array() + model.geom_margin[geom];
}

/// All that a step starts from.
void copy_motion(const mjModel& model, const mjData& from, mjData& to) {
  to.time = from.time;
  std::copy_n(from.qpos, model.nq, to.qpos);
  std::copy_n(from.qvel, model.nv, to.qvel);
  std::copy_n(from.act, model.na, to.act);
  std::copy_n(from.ctrl, model.nu, to.ctrl);
  std::copy_n(from.qacc_warmstart, model.nv, to.qacc_warmstart);
}

std::vector<int> numbers_of(const std::vector<bool>& kept) {
  std::vector<int> numbers;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) numbers.push_back(static_cast<int>(i));
  }
  return numbers;
}

}  // namespace

PhysicsFocus::PhysicsFocus(const World& world, const mjModel& model)
    : whole_(model),
      near_(model),
      near_state_(world.make_data()),
      robot_body_(world.robot_body()),
      all_geoms_(refers_to_geoms(model) || others_move(world, model)),
      all_bodies_(all_geoms_ || refers_to_bodies(model)),
      geom_is_near_(static_cast<size_t>(model.ngeom), all_geoms_) {
  if (all_geoms_) return;
  const Eigen::Vector3d p_world_robot = position(near_state_->xpos + 3 * robot_body_);
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!has_effect(model, geom)) continue;
    if (stands(model, model.geom_bodyid[geom])) {
      obstacles_.push_back({geom, half_size_m(model, geom), T_geom_world(*near_state_, geom)});
    } else {
      geom_is_near_[static_cast<size_t>(geom)] = true;
      const double away_m = (position(near_state_->geom_xpos + 3 * geom) - p_world_robot).norm();
      robot_radius_m_ = std::max(robot_radius_m_, away_m + model.geom_rbound[geom] + model.geom_margin[geom]);
    }
  }
}

void PhysicsFocus::step(mjData& state) {
  look_round(position(state.qpos + whole_.jnt_qposadr[whole_.body_jntadr[robot_body_]]));
  copy_motion(whole_, state, *near_state_);
  mj_step(&near_, near_state_.get());
  copy_motion(whole_, *near_state_, state);
}

/// Notices what the robot has come near to.
void PhysicsFocus::look_round(const Eigen::Vector3d& p_world_robot) {
  if (looked_ && (p_world_robot - p_world_looked_).norm() < kUpdate_m) return;
  if (!looked_) {
    mj_kinematics(&whole_, near_state_.get());
    for (Obstacle& obstacle : obstacles_) {
      obstacle.T_geom_world = T_geom_world(*near_state_, obstacle.geom);
    }
  }
  for (const Obstacle& obstacle : obstacles_) {
    const Eigen::Vector3d p_geom_robot = obstacle.T_geom_world * p_world_robot;
    const Eigen::Vector3d outside_m = (p_geom_robot.cwiseAbs() - obstacle.half_size_m).cwiseMax(0);
    geom_is_near_[static_cast<size_t>(obstacle.geom)] = outside_m.norm() - robot_radius_m_ < kReach_m;
  }
  reduce();
  p_world_looked_ = p_world_robot;
  looked_ = true;
}

/// Bodies that move or have a geom that is near, and those that they are fixed to.
std::vector<bool> PhysicsFocus::kept_bodies() const {
  std::vector<bool> kept(static_cast<size_t>(whole_.nbody), all_bodies_);
  kept[0] = true;
  for (const int geom : numbers_of(geom_is_near_)) kept[static_cast<size_t>(whole_.geom_bodyid[geom])] = true;
  for (int body = whole_.nbody - 1; body > 0; --body) {  // parents come before their children
    const auto i = static_cast<size_t>(body);
    kept[i] = kept[i] || !stands(whole_, body);
    if (kept[i]) kept[static_cast<size_t>(whole_.body_parentid[body])] = true;
  }
  return kept;
}

/// Makes near_ of whole_: arrays of bodies and geoms have the rows that are kept, all others are shared.
void PhysicsFocus::reduce() {
  const std::vector<int> bodies = numbers_of(kept_bodies()), geoms = numbers_of(geom_is_near_);
  near_ = whole_;
  near_.nbody = static_cast<int>(bodies.size());
  near_.ngeom = static_cast<int>(geoms.size());
  near_rows_.release();
  const auto new_array = [&]<typename T>(T*& array, int count) {
    array = static_cast<T*>(near_rows_.allocate(static_cast<size_t>(count) * sizeof(T), alignof(T)));
  };
  const auto take_rows = [&]<typename T>(std::string_view rows, const T* from, T*& array, int columns) {
    if (rows != "nbody" && rows != "ngeom") return;
    const std::vector<int>& kept = rows == "nbody" ? bodies : geoms;
    new_array(array, static_cast<int>(kept.size()) * columns);
    T* to = array;
    for (const int row : kept) to = std::copy_n(from + row * columns, columns, to);
  };
  MJMODEL_POINTERS_PREAMBLE((&whole_))
#define X(type, name, rows, columns) take_rows(#rows, whole_.name, near_.name, columns);
  MJMODEL_POINTERS
#undef X

  // numbers of bodies and geoms within the arrays
  std::vector<int> new_number(static_cast<size_t>(whole_.nbody), -1);
  for (int i = 0; i < near_.nbody; ++i) new_number[static_cast<size_t>(bodies[static_cast<size_t>(i)])] = i;
  const auto renumber_bodies = [&](int*& array, int count) {
    const int* old = array;
    new_array(array, count);
    for (int i = 0; i < count; ++i) array[i] = new_number[static_cast<size_t>(old[i])];
  };
  renumber_bodies(near_.body_parentid, near_.nbody);
  renumber_bodies(near_.body_rootid, near_.nbody);
  renumber_bodies(near_.body_weldid, near_.nbody);
  renumber_bodies(near_.geom_bodyid, near_.ngeom);
  renumber_bodies(near_.jnt_bodyid, near_.njnt);
  renumber_bodies(near_.dof_bodyid, near_.nv);
  std::fill_n(near_.body_geomnum, near_.nbody, 0);
  for (int geom = 0; geom < near_.ngeom; ++geom) {
    const int body = near_.geom_bodyid[geom];
    if (near_.body_geomnum[body]++ == 0) near_.body_geomadr[body] = geom;
  }

  // what only looks on: no step asks for it
  near_.ncam = near_.nlight = near_.nsensor = 0;
  if (!all_bodies_) near_.nsite = 0;
}

}  // namespace groundloop::sim
