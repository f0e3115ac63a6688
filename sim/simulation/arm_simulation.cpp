#include "sim/simulation/arm_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/arm/arm_errors.h"
#include "sim/arm/arm_plan.h"
#include "sim/arm/arm_servo.h"
#include "sim/simulation/state_pool.h"

namespace groundloop::sim {
namespace {

/// Poses beside a planned one may lie nearer to the stretched arm than the plan may.
JointLimits limits_of_errors(JointLimits limits) {
  limits.least_elbow_rad /= 9;
  return limits;
}

}  // namespace

struct ArmSimulation::Impl {
  Impl(const World& world_, const HeadModel& head_, const Scenario& scenario_);

  size_t stop_of(int64_t pair) const;
  JointAngles sent_to(size_t stop, Side side, int64_t pair) const;
  std::shared_ptr<const mjData> stand(size_t stop, Side side, int64_t pair);
  slam::Pose T_world_camera(const mjData& state) const;
  Exposure expose(int64_t pair);

  const Scenario scenario;
  const World& world;
  const HeadModel head;
  const slam::Pose T_body_left;
  const Lighting lighting;
  const ArmModel arm;
  const ArmPlan plan;
  const slam::Pose T_flange_camera;  ///< as it is
  const int64_t pairs;
  ArmServo servo;
  StatePool pool;
  int64_t next_pair = 0;
};

ArmSimulation::Impl::Impl(const World& world_, const HeadModel& head_, const Scenario& scenario_)
    : scenario(scenario_),
      world(world_),
      head(head_),
      T_body_left(head.rig().T_body_left),
      lighting(world.model(), scenario),
      arm(find_arm(world, scenario.robot.model)),
      plan(plan_arm(scenario, world, arm, head.baseline_m, head.period_ns())),
      T_flange_camera(arm.T_flange_camera * hand_eye_error(scenario.robot.arm.hand_eye)),
      pairs(plan.stops.back().first_pair + 1),
      servo(world, arm, plan.q.front()[kLeft]),
      pool(world.model()) {}

/// The stop at which a pair is taken.
size_t ArmSimulation::Impl::stop_of(int64_t pair) const {
  const auto after = std::upper_bound(plan.stops.begin(), plan.stops.end(), pair,
                                      [](int64_t p, const CameraStop& stop) { return p < stop.first_pair; });
  return static_cast<size_t>(after - plan.stops.begin()) - 1;
}

/// Joint angles that the arm goes to: those of the plan, and off by what it repeats worse than perfectly.
JointAngles ArmSimulation::Impl::sent_to(size_t stop, Side side, int64_t pair) const {
  const JointAngles& planned = plan.q[stop][side];
  const ArmErrors& errors = scenario.robot.arm;
  if (errors.repeatability_m == 0 && errors.repeatability_deg == 0) return planned;
  const slam::Pose T_base_flange =
      forward_kinematics(arm.geometry, planned) * repeatability_error(errors, scenario.seed, 2 * pair + side);
  const InverseKinematics beside =
      inverse_kinematics(arm.geometry, limits_of_errors(arm.limits), T_base_flange, planned);
  if (beside.solutions.empty()) {
    throw InputError(
        Problem{scenario.file, plan.stops[stop].line, plan.stops[stop].key,
                "with the arm's error there is no such pose: " + beside.reason,
                "a place farther within the arm's reach, or a smaller robot.arm.repeatability_m"});
  }
  return *std::min_element(beside.solutions.begin(), beside.solutions.end(),
                           [&](const JointAngles& a, const JointAngles& b) {
                             return (a - planned).squaredNorm() < (b - planned).squaredNorm();
                           });
}

/// Moves the arm there; the state in which it stands.
std::shared_ptr<const mjData> ArmSimulation::Impl::stand(size_t stop, Side side, int64_t pair) {
  const JointAngles q = sent_to(stop, side, pair);
  const slam::Pose T_world_from = T_world_camera(servo.state());
  const double way_m = (ArmPlan::T_world_camera(plan.stops[stop], side, head.baseline_m).translation() -
                        T_world_from.translation())
                           .norm();
  if (!servo.move_to(q, way_m / (scenario.scale * scenario.plan.speed_mps))) {
    throw InputError(Problem{scenario.file, plan.stops[stop].line, plan.stops[stop].key,
                             fmt::format("{} s after its motion {}", kSettleLimit_s, servo.unrest(q)),
                             "an arm whose servos come to rest (" + scenario.robot.model + ")"});
  }
  const std::shared_ptr<mjData> state = pool.copy(servo.state());
  mj_kinematics(&world.model(), state.get());
  mj_comPos(&world.model(), state.get());
  mj_camlight(&world.model(), state.get());
  state->time = static_cast<double>(pair * head.period_ns()) * 1e-9;
  return state;
}

slam::Pose ArmSimulation::Impl::T_world_camera(const mjData& state) const {
  return arm.T_world_flange(state) * T_flange_camera;
}

Exposure ArmSimulation::Impl::expose(int64_t pair) {
  const size_t stop = stop_of(pair);
  const double before_s = servo.time_s();
  Exposure exposure;
  exposure.index = pair;
  exposure.stamp_ns = pair * head.period_ns();
  exposure.state = stand(stop, kLeft, pair);
  exposure.state_right = stand(stop, kRight, pair);
  const double period_s = static_cast<double>(head.period_ns()) * 1e-9, took_s = servo.time_s() - before_s;
  if (pair > 0 && took_s > period_s) {
    throw InputError(
        Problem{scenario.file, plan.stops[stop].line, plan.stops[stop].key,
                fmt::format("the arm takes {:.2f} s to stand there twice", took_s),
                fmt::format("at most {} s, the time between pairs: a lower rate_hz of the head, a higher "
                            "plan.speed_mps or a nearer stop",
                            period_s)});
  }
  exposure.T_world_left = T_world_camera(*exposure.state);
  exposure.T_world_right = T_world_camera(*exposure.state_right);
  exposure.T_world_body = exposure.T_world_left * T_body_left.inverse();
  exposure.lights = lighting.at(static_cast<double>(exposure.stamp_ns) * 1e-9);

  // what the arm knows: where it was sent
  const slam::Pose& T_world_planned = plan.stops[stop].T_world_left;
  exposure.T_plan_body = T_world_planned * T_body_left.inverse();
  exposure.T_odom_body = T_body_left * plan.stops.front().T_world_left.inverse() * exposure.T_plan_body;
  if (pair > 0) {
    exposure.T_previous_left = plan.stops[stop_of(pair - 1)].T_world_left.inverse() * T_world_planned;
  } else {
    exposure.T_previous_left.setIdentity();
  }
  return exposure;
}

ArmSimulation::ArmSimulation(const World& world, const HeadModel& head, const Scenario& scenario)
    : impl_(std::make_unique<Impl>(world, head, scenario)) {}
ArmSimulation::~ArmSimulation() = default;

std::optional<Exposure> ArmSimulation::advance() {
  if (impl_->next_pair >= impl_->pairs) return std::nullopt;
  return impl_->expose(impl_->next_pair++);
}

int64_t ArmSimulation::exposure_count() const { return impl_->pairs; }

double ArmSimulation::planned_length_m() const {
  double length_m = 0;
  const std::vector<CameraStop>& stops = impl_->plan.stops;
  for (size_t i = 1; i < stops.size(); ++i) {
    length_m += (stops[i].T_world_left.translation() - stops[i - 1].T_world_left.translation()).norm();
  }
  return length_m;
}

slam::Pose ArmSimulation::planned_T_world_body(double time_s) const {
  const auto pair =
      static_cast<int64_t>(std::floor(time_s * 1e9 / static_cast<double>(impl_->head.period_ns()) + 1e-6));
  const size_t stop = impl_->stop_of(std::clamp<int64_t>(pair, 0, impl_->pairs - 1));
  return impl_->plan.stops[stop].T_world_left * impl_->T_body_left.inverse();
}

double ArmSimulation::planned_duration_s() const {
  return static_cast<double>((impl_->pairs - 1) * impl_->head.period_ns()) * 1e-9;
}

}  // namespace groundloop::sim
