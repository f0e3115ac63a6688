#include "sim/simulation/kidnapping.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace groundloop::sim {

Pose2 pose_of(const KidnapFault& kidnap) {
  return {kidnap.x_m, kidnap.y_m, kidnap.yaw_deg * std::numbers::pi / 180};
}

Pose2 carried(const Pose2& T_world_from, const Pose2& T_world_to, const Pose2& T_world_pose) {
  return composed(T_world_to, composed(inverse(T_world_from), T_world_pose));
}

std::vector<Fault> kidnappings_of(const std::vector<Fault>& faults) {
  std::vector<Fault> kidnappings;
  std::copy_if(faults.begin(), faults.end(), std::back_inserter(kidnappings),
               [](const Fault& fault) { return fault.kidnap.has_value(); });
  std::stable_sort(kidnappings.begin(), kidnappings.end(),
                   [](const Fault& a, const Fault& b) { return a.at_s < b.at_s; });
  return kidnappings;
}

Kidnapping::Kidnapping(const World& world, const std::vector<Fault>& faults) : world_(world) {
  for (const Fault& fault : kidnappings_of(faults))
    events_.push_back({std::llround(fault.at_s * 1e9), *fault.kidnap});
  std::reverse(events_.begin(), events_.end());
}

void Kidnapping::update(int64_t time_ns, mjData& state) {
  while (!events_.empty() && events_.back().at_ns <= time_ns) {
    put_down(events_.back().there, state);
    events_.pop_back();
  }
}

void Kidnapping::put_down(const KidnapFault& there, mjData& state) {
  // coordinates of a free joint: position and quaternion; velocity in the world, rotation in the body
  const mjModel& model = world_.model();
  const int joint = model.body_jntadr[world_.robot_body()];
  mjtNum* q = state.qpos + model.jnt_qposadr[joint];
  mjtNum* v = state.qvel + model.jnt_dofadr[joint];

  slam::Pose T_world_body = slam::Pose::Identity();
  T_world_body.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).toRotationMatrix();
  T_world_body.translation() << q[0], q[1], q[2];
  const Pose2 from = to_pose2(T_world_body), to = pose_of(there);

  q[0] = to.x_m;
  q[1] = to.y_m;
  const double turn_rad = to.yaw_rad - from.yaw_rad;
  const mjtNum turn[4] = {std::cos(turn_rad / 2), 0, 0, std::sin(turn_rad / 2)};
  const mjtNum before[4] = {q[3], q[4], q[5], q[6]};
  mju_mulQuat(q + 3, turn, before);
  const mjtNum velocity[3] = {v[0], v[1], v[2]};
  mju_rotVecQuat(v, velocity, turn);
  T_world_plan_ = carried(from, to, T_world_plan_);
}

}  // namespace groundloop::sim
