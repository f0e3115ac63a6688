#include "sim/arm/arm_servo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

/// Progress from 0 to 1 in unit time with speed and acceleration 0 at both ends.
struct Progress {
  explicit Progress(double t)
      : value(t * t * t * (10 + t * (-15 + 6 * t))),
        rate(30 * t * t * (1 - t) * (1 - t)),
        acceleration(60 * t * (1 - t) * (1 - 2 * t)) {}
  static constexpr double kTopRate = 1.875;
  static constexpr double kTopAcceleration = 5.7735026918962575;  // 10 / sqrt(3)
  double value, rate, acceleration;
};

}  // namespace

ArmServo::ArmServo(const World& world, const ArmModel& arm, const JointAngles& start)
    : arm_(arm),
      model_(world.model()),
      state_(world.make_data()),
      q_(start),
      acceleration_(static_cast<size_t>(model_.nv)),
      inertia_force_(static_cast<size_t>(model_.nv)) {
  model_.opt.disableflags |= mjDSBL_CONTACT;
  arm_.set_angles(start, *state_);
  mj_forward(&model_, state_.get());
}

double ArmServo::duration_s(const ArmModel& arm, const JointAngles& way, double least_s) {
  const double widest_rad = way.cwiseAbs().maxCoeff();
  return std::max({Progress::kTopRate * least_s, Progress::kTopRate * widest_rad / arm.joint_speed_radps,
                   std::sqrt(Progress::kTopAcceleration * widest_rad / arm.joint_acceleration_radps2)});
}

bool ArmServo::move_to(const JointAngles& q, double least_s) {
  const JointAngles from = q_, way = q - q_;
  const double step_s = model_.opt.timestep;
  const auto steps = static_cast<int>(std::ceil(duration_s(arm_, way, least_s) / step_s));
  for (int i = 1; i <= steps; ++i) {
    const Progress progress(static_cast<double>(i) / steps);
    const double whole_s = steps * step_s;
    step({from + progress.value * way, progress.rate / whole_s * way,
          progress.acceleration / (whole_s * whole_s) * way});
  }
  q_ = q;
  const Wanted rest = {q, JointAngles::Zero(), JointAngles::Zero()};
  const double deadline_s = state_->time + kSettleLimit_s;
  while (!stands_at(q)) {
    if (state_->time >= deadline_s) return false;
    step(rest);
  }
  return true;
}

/// A servo's force is stiffness (input - angle): what the motion will need is added to its input.
void ArmServo::step(const Wanted& wanted) {
  for (int i = 0; i < 6; ++i) {
    acceleration_[static_cast<size_t>(arm_.joints[static_cast<size_t>(i)].dof)] = wanted.acceleration[i];
  }
  mj_mulM(&model_, state_.get(), inertia_force_.data(), acceleration_.data());
  for (int i = 0; i < 6; ++i) {
    const ArmModel::Joint& joint = arm_.joints[static_cast<size_t>(i)];
    const double force = state_->qfrc_bias[joint.dof] + inertia_force_[static_cast<size_t>(joint.dof)] +
                         joint.damping * wanted.rate[i];
    state_->ctrl[joint.actuator] = wanted.q[i] + force / joint.stiffness;
  }
  mj_step(&model_, state_.get());
}

bool ArmServo::stands_at(const JointAngles& q) const {
  return std::all_of(arm_.joints.begin(), arm_.joints.end(),
                     [&, i = 0](const ArmModel::Joint& joint) mutable {
                       return std::abs(state_->qpos[joint.qpos] - q[i++]) < kSettled_rad &&
                              std::abs(state_->qvel[joint.dof]) < kStill_radps;
                     });
}

std::string ArmServo::unrest(const JointAngles& q) const {
  constexpr double kDegrees = 180 / std::numbers::pi;
  size_t worst = 0;
  double off_rad = 0;
  for (size_t i = 0; i < 6; ++i) {
    const double here_rad = std::abs(state_->qpos[arm_.joints[i].qpos] - q[static_cast<Eigen::Index>(i)]);
    if (here_rad >= off_rad) off_rad = here_rad, worst = i;
  }
  return fmt::format("joint {} is {:.2g} deg off and turns at {:.2g} deg/s", worst + 1, off_rad * kDegrees,
                     std::abs(state_->qvel[arm_.joints[worst].dof]) * kDegrees);
}

}  // namespace groundloop::sim
