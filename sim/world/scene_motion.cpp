#include "sim/world/scene_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace groundloop::sim {
namespace {

constexpr double kArmSwing = 0.8;  ///< of the legs'

}  // namespace

SceneMotion::SceneMotion(const World& world, const Scenario& scenario)
    : world_(world),
      model_(world.model()),
      body_pos_(model_.body_pos, model_.body_pos + 3 * model_.nbody),
      body_quat_(model_.body_quat, model_.body_quat + 4 * model_.nbody) {
  model_.body_pos = body_pos_.data();
  model_.body_quat = body_quat_.data();
  check_moves(scenario);
  for (const Person& person : scenario.people) people_.push_back(walker_of(person));
  const World::DataPtr at_start = world.make_data();
  for (const Move& move : scenario.moves) moves_.push_back(placed(move, *at_start));
  std::stable_sort(moves_.begin(), moves_.end(),
                   [](const Placed& a, const Placed& b) { return a.at_s < b.at_s; });
  place(0);
}

int SceneMotion::body_named(const std::string& name) const {
  return mj_name2id(&model_, mjOBJ_BODY, name.c_str());
}

void SceneMotion::check_moves(const Scenario& scenario) const {
  std::set<int> moved;
  for (const Move& move : scenario.moves) moved.insert(body_named(move.body));
  std::vector<Problem> problems;
  for (size_t i = 0; i < scenario.moves.size(); ++i) {
    const Move& move = scenario.moves[i];
    const int body = body_named(move.body);
    const auto refuse = [&](const std::string& wanted) {
      problems.push_back({scenario.file, move.line, fmt::format("moves[{}].body", i), move.body, wanted});
    };
    if (body <= 0) {
      refuse("the name of a body of the world");
    } else if (model_.body_weldid[body] != 0) {
      refuse("a body that has no joint");
    } else {
      for (int parent = model_.body_parentid[body]; parent > 0; parent = model_.body_parentid[parent]) {
        if (moved.contains(parent)) refuse("a body that does not stand on one that is moved itself");
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

SceneMotion::Walker SceneMotion::walker_of(const Person& person) const {
  Walker walker{body_named(person.name), 0, Walk(person), {}};
  const std::array<std::pair<const char*, double>, 4> kLimbs = {
      {{"left_leg", 1}, {"right_leg", -1}, {"left_arm", -kArmSwing}, {"right_arm", kArmSwing}}};
  for (const auto& [name, sign] : kLimbs) {
    const int body = body_named(person.name + "/" + name);
    if (body < 0) continue;
    Limb limb{body, sign, {}};
    std::copy_n(&body_quat_[4 * static_cast<size_t>(body)], 4, limb.rest);
    walker.limbs.push_back(limb);
    if (std::abs(sign) == 1) walker.hip_m = body_pos_[3 * static_cast<size_t>(body) + 2];
  }
  return walker;
}

/// Where a move puts its body, in the frame of its parent: at its height, turned about the vertical.
SceneMotion::Placed SceneMotion::placed(const Move& move, const mjData& at_start) const {
  Placed result{};
  result.body = body_named(move.body);
  result.at_s = move.at_s;
  const int parent = model_.body_parentid[result.body];
  const mjtNum* before = at_start.xmat + 9 * result.body;
  const double turn_rad = move.yaw_deg * std::numbers::pi / 180 - std::atan2(before[3], before[0]);
  const mjtNum turn[4] = {std::cos(turn_rad / 2), 0, 0, std::sin(turn_rad / 2)};
  const mjtNum pos_world[3] = {move.x_m, move.y_m, at_start.xpos[3 * result.body + 2]};
  mjtNum quat_world[4], pos_parent[3], quat_parent[4];
  mju_mulQuat(quat_world, turn, at_start.xquat + 4 * result.body);
  mju_negPose(pos_parent, quat_parent, at_start.xpos + 3 * parent, at_start.xquat + 4 * parent);
  mju_mulPose(result.pos, result.quat, pos_parent, quat_parent, pos_world, quat_world);
  return result;
}

/// Both feet stay on the floor: a leg that swings out reaches less far down.
void SceneMotion::put(const Walker& walker, double time_s) {
  const Stance stance = walker.walk.at(time_s);
  mjtNum* pos = &body_pos_[3 * static_cast<size_t>(walker.body)];
  pos[0] = stance.p_world.x();
  pos[1] = stance.p_world.y();
  pos[2] = -walker.hip_m * (1 - std::cos(stance.swing_rad));
  mjtNum* quat = &body_quat_[4 * static_cast<size_t>(walker.body)];
  quat[0] = std::cos(stance.yaw_rad / 2);
  quat[1] = quat[2] = 0;
  quat[3] = std::sin(stance.yaw_rad / 2);
  for (const Limb& limb : walker.limbs) {
    // a turn about y takes what hangs down backwards
    const double half_rad = -limb.sign * stance.swing_rad / 2;
    const mjtNum swing[4] = {std::cos(half_rad), 0, std::sin(half_rad), 0};
    mju_mulQuat(&body_quat_[4 * static_cast<size_t>(limb.body)], limb.rest, swing);
  }
}

bool SceneMotion::place(double time_s) {
  for (const Walker& walker : people_) put(walker, time_s);
  const auto due = std::upper_bound(moves_.begin(), moves_.end(), time_s,
                                    [](double t_s, const Placed& move) { return t_s < move.at_s; });
  const auto done = static_cast<size_t>(due - moves_.begin());
  if (done == moves_done_) return false;
  if (done < moves_done_) {  // back in time
    std::copy_n(world_.model().body_pos, body_pos_.size(), body_pos_.begin());
    std::copy_n(world_.model().body_quat, body_quat_.size(), body_quat_.begin());
    for (const Walker& walker : people_) put(walker, time_s);
  }
  for (size_t i = 0; i < done; ++i) {
    const auto body = static_cast<size_t>(moves_[i].body);
    std::copy_n(moves_[i].pos, 3, &body_pos_[3 * body]);
    std::copy_n(moves_[i].quat, 4, &body_quat_[4 * body]);
  }
  moves_done_ = done;
  return true;
}

}  // namespace groundloop::sim
