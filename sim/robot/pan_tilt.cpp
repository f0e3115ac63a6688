#include "sim/robot/pan_tilt.h"

#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "sim/robot/drive.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

slam::Pose pose_of_body(const mjData& state, int body) {
  slam::Pose T_world_body = slam::Pose::Identity();
  const mjtNum* R = state.xmat + 9 * body;
  T_world_body.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R);
  T_world_body.translation() = Eigen::Map<const Eigen::Vector3d>(state.xpos + 3 * body);
  return T_world_body;
}

}  // namespace

std::optional<PanTilt> PanTilt::find(const World& world, const std::string& robot_file,
                                     const slam::Pose& T_body_left) {
  const std::array<int, 2> actuators = {find_hinge_actuator(world, "_pan"),
                                        find_hinge_actuator(world, "_tilt")};
  if (actuators[0] < 0 && actuators[1] < 0) return std::nullopt;
  std::vector<Problem> problems;
  const auto missing = [&](const std::string& what, const std::string& wanted) {
    problems.push_back({robot_file, 0, what, "missing", wanted});
  };
  for (int i = 0; i < 2; ++i) {
    if (actuators[i] >= 0) continue;
    missing(i == 0 ? "_pan" : "_tilt",
            "a position actuator whose name ends so on a hinge joint, as a pan-tilt head has");
  }
  const double acceleration_radps2 = find_numeric(world, "_look_acceleration_radps2");
  if (!(acceleration_radps2 > 0)) {
    missing("look_acceleration_radps2", "<custom><numeric> whose name ends so, above 0");
  }
  if (!problems.empty()) throw InputError(problems);
  PanTilt head(world, actuators, acceleration_radps2);
  head.T_tilt_left_ = head.T_body_tilt({}).inverse() * T_body_left;
  return head;
}

PanTilt::PanTilt(const World& world, const std::array<int, 2>& actuators, double acceleration_radps2)
    : world_(&world), acceleration_radps2_(acceleration_radps2), scratch_(world.make_data()) {
  const mjModel& model = world.model();
  for (size_t i = 0; i < 2; ++i) {
    const int joint = model.actuator_trnid[2 * actuators[i]];
    const bool limited = model.jnt_limited[joint] != 0;
    const double stiffness = model.actuator_gainprm[mjNGAIN * actuators[i]];
    joints_[i] = {actuators[i], model.jnt_qposadr[joint],
                  limited ? model.jnt_range[2 * joint] : -std::numbers::pi,
                  limited ? model.jnt_range[2 * joint + 1] : std::numbers::pi,
                  model.dof_damping[model.jnt_dofadr[joint]] / stiffness};
  }
  tilt_body_ = model.jnt_bodyid[model.actuator_trnid[2 * actuators[1]]];
}

slam::Pose PanTilt::T_body_tilt(const HeadAngles& head) const {
  scratch_->qpos[joints_[0].qpos] = head.pan_rad;
  scratch_->qpos[joints_[1].qpos] = head.tilt_rad;
  mj_kinematics(&world_->model(), scratch_.get());
  return pose_of_body(*scratch_, world_->robot_body()).inverse() * pose_of_body(*scratch_, tilt_body_);
}

slam::Pose PanTilt::T_body_left(const HeadAngles& head) const { return T_body_tilt(head) * T_tilt_left_; }

slam::Pose PanTilt::T_world_left(const mjData& state) const {
  return pose_of_body(state, tilt_body_) * T_tilt_left_;
}

void PanTilt::steer(const PlannedState& planned, mjData& state) const {
  state.ctrl[joints_[0].actuator] = planned.head.pan_rad + joints_[0].lead_s * planned.head_rate.pan_rad;
  state.ctrl[joints_[1].actuator] = planned.head.tilt_rad + joints_[1].lead_s * planned.head_rate.tilt_rad;
}

void check_looks(const Scenario& scenario, const std::optional<PanTilt>& head) {
  std::vector<Problem> problems;
  for (size_t i = 0; i < scenario.plan.segments.size(); ++i) {
    const Segment& segment = scenario.plan.segments[i];
    if (!segment.look) continue;
    const std::string key = fmt::format("plan.segments[{}].look", i);
    if (!head) {
      problems.push_back({scenario.file, segment.line, key, scenario.robot.model,
                          "a robot with a pan-tilt head (p3dx_pan_tilt.xml is one)"});
      continue;
    }
    const auto check = [&](const char* axis, double angle_deg, double low_rad, double high_rad) {
      if (angle_deg * kDegree >= low_rad - 1e-9 && angle_deg * kDegree <= high_rad + 1e-9) return;
      problems.push_back({scenario.file, segment.line, key + axis, fmt::format("{}", angle_deg),
                          fmt::format("{:.0f} to {:.0f}, what the robot's joint can do", low_rad / kDegree,
                                      high_rad / kDegree)});
    };
    check(".pan_deg", segment.look->pan_deg, head->lowest().pan_rad, head->highest().pan_rad);
    check(".tilt_deg", segment.look->tilt_deg, head->lowest().tilt_rad, head->highest().tilt_rad);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace groundloop::sim
