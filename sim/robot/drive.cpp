#include "sim/robot/drive.h"

#include <cmath>
#include <string_view>

namespace groundloop::sim {
namespace {

std::string_view name_of(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name == nullptr ? std::string_view() : std::string_view(name);
}

/// Radius of the round geom of a wheel that touches the floor; 0 when there is none.
double rolling_radius_m(const mjModel& model, int joint) {
  const int body = model.jnt_bodyid[joint];
  for (int k = 0; k < model.body_geomnum[body]; ++k) {
    const int geom = model.body_geomadr[body] + k;
    const int type = model.geom_type[geom];
    const bool round = type == mjGEOM_CYLINDER || type == mjGEOM_SPHERE || type == mjGEOM_ELLIPSOID;
    if (round && (model.geom_contype[geom] | model.geom_conaffinity[geom]) != 0)
      return model.geom_size[3 * geom];
  }
  return 0;
}

}  // namespace

int find_hinge_actuator(const World& world, std::string_view ending) {
  const mjModel& model = world.model();
  for (int actuator = 0; actuator < model.nu; ++actuator) {
    if (!name_of(model, mjOBJ_ACTUATOR, actuator).ends_with(ending)) continue;
    if (model.actuator_trntype[actuator] != mjTRN_JOINT) continue;
    const int joint = model.actuator_trnid[2 * actuator];
    const bool own = model.body_rootid[model.jnt_bodyid[joint]] == world.robot_body();
    if (own && model.jnt_type[joint] == mjJNT_HINGE) return actuator;
  }
  return -1;
}

double find_numeric(const World& world, std::string_view ending) {
  const mjModel& model = world.model();
  for (int numeric = 0; numeric < model.nnumeric; ++numeric) {
    if (name_of(model, mjOBJ_NUMERIC, numeric).ends_with(ending)) {
      return model.numeric_data[model.numeric_adr[numeric]];
    }
  }
  return 0;
}

Drive find_drive(const World& world, const std::string& robot_file) {
  const mjModel& model = world.model();
  std::vector<Problem> problems;
  const auto missing = [&](const std::string& what, const std::string& wanted) {
    problems.push_back({robot_file, 0, what, "missing", wanted});
  };
  Drive drive;
  drive.left_actuator = find_hinge_actuator(world, "left_wheel");
  drive.right_actuator = find_hinge_actuator(world, "right_wheel");
  if (drive.left_actuator < 0)
    missing("left_wheel", "a velocity actuator of that name on a hinge joint of the robot");
  if (drive.right_actuator < 0)
    missing("right_wheel", "a velocity actuator of that name on a hinge joint of the robot");
  drive.limits.wheel_acceleration_radps2 = find_numeric(world, "wheel_acceleration_radps2");
  if (!(drive.limits.wheel_acceleration_radps2 > 0)) {
    missing("wheel_acceleration_radps2", "<custom><numeric> of that name, above 0");
  }
  if (!problems.empty()) throw InputError(problems);

  const int left = model.actuator_trnid[2 * drive.left_actuator];
  const int right = model.actuator_trnid[2 * drive.right_actuator];
  drive.left_qpos = model.jnt_qposadr[left];
  drive.right_qpos = model.jnt_qposadr[right];
  drive.limits.wheel_radius_m = rolling_radius_m(model, left);
  drive.limits.track_m =
      model.body_pos[3 * model.jnt_bodyid[left] + 1] - model.body_pos[3 * model.jnt_bodyid[right] + 1];
  drive.limits.wheel_speed_radps = model.actuator_ctrlrange[2 * drive.left_actuator + 1];
  if (!(drive.limits.wheel_radius_m > 0)) missing("left_wheel", "a round geom that touches the floor");
  if (drive.limits.wheel_radius_m != rolling_radius_m(model, right))
    missing("right_wheel", "the left wheel's radius");
  if (!(drive.limits.track_m > 0)) missing("left_wheel", "a place to the left of the right wheel");
  if (!(drive.limits.wheel_speed_radps > 0)) missing("left_wheel", "a ctrlrange, the wheel's speed limit");
  if (!problems.empty()) throw InputError(problems);
  return drive;
}

}  // namespace groundloop::sim
