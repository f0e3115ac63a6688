#include "sim/simulation/simulation.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "sim/faults/head_faults.h"
#include "sim/robot/controller.h"
#include "sim/robot/drive.h"
#include "sim/robot/odometry.h"
#include "sim/robot/pan_tilt.h"
#include "sim/robot/planned_path.h"
#include "sim/robot/wheel_angles.h"
#include "sim/simulation/arm_simulation.h"
#include "sim/simulation/kidnapping.h"
#include "sim/simulation/path_check.h"
#include "sim/simulation/physics_focus.h"
#include "sim/simulation/state_pool.h"
#include "sim/truth/truth_world.h"
#include "sim/world/scene_motion.h"

namespace groundloop::sim {
namespace {

constexpr double kSettle_s = 0.5;
constexpr double kSettled_m = 0.01;  ///< how far the robot may sink or slide while it settles
constexpr double kLongestStep_s = 0.0021;

/// Pose of the robot's body frame: the coordinates of its free joint.
slam::Pose body_pose(const World& world, const mjData& state) {
  const mjtNum* q = state.qpos + world.model().jnt_qposadr[world.model().body_jntadr[world.robot_body()]];
  slam::Pose T_world_body = slam::Pose::Identity();
  T_world_body.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
  T_world_body.translation() << q[0], q[1], q[2];
  return T_world_body;
}

void update_kinematics(const mjModel& model, mjData& state) {
  mj_kinematics(&model, &state);
  mj_comPos(&model, &state);
  mj_camlight(&model, &state);
}

/// The drive as plan, wheel control and odometry take it to be.
Drive assumed_drive(const World& world, const RobotChoice& robot) {
  Drive drive = find_drive(world, robot.model);
  drive.limits.track_m /= robot.drive.track_ratio;
  return drive;
}

int64_t step_ns_of(const mjModel& model, const Scenario& scenario) {
  if (model.opt.timestep > kLongestStep_s) {
    throw InputError(Problem{scenario.robot.model, 0, "option.timestep",
                             fmt::format("{}", model.opt.timestep), "a physics step of 2 ms or less"});
  }
  return std::llround(model.opt.timestep * 1e9);
}

}  // namespace

struct Simulation::Wheeled : HeadCarrier {
  Wheeled(const World& world_, const HeadModel& head, const Scenario& scenario, PoseFeedback core_pose_);

  std::optional<Exposure> advance() override;
  int64_t exposure_count() const override { return exposures; }
  double planned_length_m() const override { return path.length_m(); }
  slam::Pose planned_T_world_body(double time_s) const override {
    return to_pose(path.at(time_s).T_world_body);
  }
  double planned_duration_s() const override { return path.duration_s(); }

  void check_path_after_moves(const Scenario& scenario);
  void settle();
  void step();
  Pose2 steering_pose() const;
  void take_slam_pose(int64_t of_exposure);
  std::array<double, 2> rolled_rad(const mjData& data) const;
  std::shared_ptr<mjData> state_at(int64_t stamp_ns);
  std::vector<SubFrame> sub_frames(double middle_s);
  slam::Pose T_world_left(const mjData& data) const;
  slam::Pose planned_T_body_left(double time_s) const;
  Exposure expose();
  void tell_expected_motion(Exposure& exposure);

  const World& world;
  SceneMotion motion;
  const mjModel& model;  ///< with everything where it is
  const Lighting lighting;
  const std::vector<Fault> faults;
  const DriveErrors drive_errors;
  Feedback feedback;
  const PoseFeedback core_pose;
  Pose2 T_world_start;
  std::string scenario_file;
  int start_line;
  Drive drive;
  slam::Pose T_body_left, T_left_right;  ///< as mounted, with the head straight ahead
  const std::vector<double> sub_frame_times_s;
  const double right_trigger_offset_s;
  std::optional<PanTilt> head_mount;
  PlannedPath path;
  int64_t step_ns, period_ns, exposures;

  World::DataPtr state;
  PhysicsFocus focus;
  StatePool pool;
  Kidnapping kidnapping;
  WheelAngles angles;
  WheelController wheels;
  Odometry odometry;
  int64_t steps = 0;
  int64_t next_exposure = 0;
  std::vector<Pose2> T_odom_body_at;  ///< by exposure
  std::optional<Pose2> T_plan_map;    ///< the core's map in the plan's world
  Pose2 T_plan_odom;                  ///< under feedback: slam
  slam::Pose T_world_expected_left;   ///< as planned, or as odometry says, at the last exposure
};

Simulation::Wheeled::Wheeled(const World& world_, const HeadModel& head, const Scenario& scenario,
                             PoseFeedback core_pose_)
    : world(world_),
      motion(world, scenario),
      model(motion.model()),
      lighting(model, scenario),
      faults(scenario.faults),
      drive_errors(scenario.robot.drive),
      feedback(scenario.plan.feedback),
      core_pose(std::move(core_pose_)),
      scenario_file(scenario.file),
      start_line(scenario.robot.start.line),
      drive(assumed_drive(world, scenario.robot)),
      T_body_left(head.rig().T_body_left),
      T_left_right(head.T_left_right()),
      sub_frame_times_s(head.sub_frame_times_s()),
      right_trigger_offset_s(head.raw ? head.raw->exposure.right_trigger_offset_s : 0),
      head_mount(PanTilt::find(world, scenario.robot.model, T_body_left)),
      path(scenario.robot.start, scenario.plan, drive.limits,
           head_mount ? head_mount->acceleration_radps2() : 1),
      step_ns(step_ns_of(model, scenario)),
      period_ns(head.period_ns()),
      exposures(static_cast<int64_t>(std::floor(path.duration_s() * 1e9 / static_cast<double>(period_ns))) +
                1),
      state(world.make_data()),
      focus(world, model),
      pool(model),
      kidnapping(world_, faults),
      angles({0, 0}),
      wheels(drive.limits, 0, 0),
      odometry(scenario.robot.odometry, drive.limits, scenario.seed, 0, 0) {
  check_looks(scenario, head_mount);
  T_world_start = path.at(0).T_world_body;
  update_kinematics(model, *state);
  check_path(scenario, path, TruthWorld(world, *state));
  if (!scenario.moves.empty()) check_path_after_moves(scenario);
  check_people(scenario, path, TruthWorld(world, *state));
  settle();
  const auto [left_rad, right_rad] = rolled_rad(*state);
  angles = WheelAngles({left_rad, right_rad});
  T_plan_odom = T_world_start;
  wheels = WheelController(drive.limits, left_rad, right_rad);
  odometry = Odometry(scenario.robot.odometry, drive.limits, scenario.seed, left_rad, right_rad);
}

/// How far the wheels have rolled.
std::array<double, 2> Simulation::Wheeled::rolled_rad(const mjData& data) const {
  return {data.qpos[drive.left_qpos], data.qpos[drive.right_qpos]};
}

/// The path must be clear of furniture wherever it stands, at any time: simple, and on the safe side.
void Simulation::Wheeled::check_path_after_moves(const Scenario& scenario) {
  motion.place(path.duration_s());
  update_kinematics(model, *state);
  check_path(scenario, path, TruthWorld(world, *state));
  motion.place(0);
  update_kinematics(model, *state);
}

/// Lets the robot sink into its contacts before time starts.
void Simulation::Wheeled::settle() {
  const slam::Pose before = body_pose(world, *state);
  while (state->time < kSettle_s) focus.step(*state);
  state->time = 0;
  const double moved_m = (body_pose(world, *state).translation() - before.translation()).norm();
  if (!(moved_m < kSettled_m)) {
    throw InputError(Problem{scenario_file, start_line, "robot.start",
                             fmt::format("the robot moves by {:.2f} m when it is put there", moved_m),
                             "a level floor at z = 0 under the robot"});
  }
}

/// Where the steering believes the robot is, in the plan's world.
Pose2 Simulation::Wheeled::steering_pose() const {
  if (feedback == Feedback::kOdometry) return composed(T_world_start, odometry.T_odom_body());
  if (feedback == Feedback::kSlam) return composed(T_plan_odom, odometry.T_odom_body());
  return composed(inverse(kidnapping.T_world_plan()), to_pose2(body_pose(world, *state)));
}

/// Lays the odometry where the core says that the robot was.
void Simulation::Wheeled::take_slam_pose(int64_t of_exposure) {
  if (of_exposure < 0) return;
  const std::optional<slam::Pose> T_map_left = core_pose(of_exposure);
  if (!T_map_left) return;
  const double time_s = static_cast<double>(of_exposure * period_ns) * 1e-9;
  const Pose2 T_map_body = to_pose2(*T_map_left * planned_T_body_left(time_s).inverse());
  const Pose2& T_odom_body = T_odom_body_at[static_cast<size_t>(of_exposure)];
  if (!T_plan_map) T_plan_map = composed(composed(T_plan_odom, T_odom_body), inverse(T_map_body));
  T_plan_odom = composed(composed(*T_plan_map, T_map_body), inverse(T_odom_body));
}

void Simulation::Wheeled::step() {
  const double step_s = model.opt.timestep;
  const double time_s = static_cast<double>(steps) * step_s;
  kidnapping.update(steps * step_ns, *state);
  if (motion.place(time_s)) focus.look_again();
  const PlannedState planned = path.at(time_s);
  const BodyTwist wanted =
      feedback == Feedback::kPlan ? planned.twist : tracking_twist(planned, steering_pose());
  const WheelSpeeds speeds = wheels.command(wanted, angles.motor_rad(0), angles.motor_rad(1), step_s);
  const WheelFaults wheel = wheel_faults(drive_errors, faults, time_s);
  state->ctrl[drive.left_actuator] = speeds.left_radps * wheel.grip[0];
  state->ctrl[drive.right_actuator] = speeds.right_radps * wheel.grip[1];
  if (head_mount) head_mount->steer(planned, *state);
  focus.step(*state);
  angles.update(rolled_rad(*state), wheel);
  odometry.update(angles.counted_rad(0), angles.counted_rad(1));
  ++steps;
}

/// A copy of the state, moved on with its velocities to a time less than a step (or a trigger offset) away.
std::shared_ptr<mjData> Simulation::Wheeled::state_at(int64_t stamp_ns) {
  if (motion.place(static_cast<double>(stamp_ns) * 1e-9)) focus.look_again();
  const std::shared_ptr<mjData> copy = pool.copy(*state);
  mj_integratePos(&model, copy->qpos, copy->qvel, static_cast<double>(stamp_ns - steps * step_ns) * 1e-9);
  update_kinematics(model, *copy);
  copy->time = static_cast<double>(stamp_ns) * 1e-9;
  return copy;
}

/// The moments of an exposure, from the left camera's place.
std::vector<SubFrame> Simulation::Wheeled::sub_frames(double middle_s) {
  std::vector<SubFrame> subs;
  for (const double from_middle_s : sub_frame_times_s) {
    const double at_s = middle_s + from_middle_s;
    const std::shared_ptr<mjData> moment = state_at(std::llround(at_s * 1e9));
    subs.push_back({moment, lighting.at(at_s), T_world_left(*moment)});
  }
  return subs;
}

slam::Pose Simulation::Wheeled::T_world_left(const mjData& data) const {
  return head_mount ? head_mount->T_world_left(data) : body_pose(world, data) * T_body_left;
}

/// Where the plan has the left camera on the robot, which knows how it has told its head to turn.
slam::Pose Simulation::Wheeled::planned_T_body_left(double time_s) const {
  return head_mount ? head_mount->T_body_left(path.at(time_s).head) : T_body_left;
}

Exposure Simulation::Wheeled::expose() {
  Exposure exposure;
  exposure.index = next_exposure++;
  if (feedback == Feedback::kSlam) take_slam_pose(exposure.index - 1 - kFeedbackPairs);
  exposure.stamp_ns = exposure.index * period_ns;
  while ((steps + 1) * step_ns <= exposure.stamp_ns) step();
  kidnapping.update(exposure.stamp_ns, *state);
  const double time_s = static_cast<double>(exposure.stamp_ns) * 1e-9;

  exposure.state = exposure.state_right = state_at(exposure.stamp_ns);
  const double offset_s = trigger_offset_s(faults, time_s) + right_trigger_offset_s;
  if (offset_s != 0) exposure.state_right = state_at(exposure.stamp_ns + std::llround(offset_s * 1e9));

  exposure.lights = lighting.at(time_s);

  // truth
  exposure.T_world_body = body_pose(world, *exposure.state);
  exposure.T_world_left = T_world_left(*exposure.state);
  const slam::Pose T_left_right_now = T_left_right * T_calibrated_right(faults, time_s);
  exposure.T_world_right = T_world_left(*exposure.state_right) * T_left_right_now;
  if (sub_frame_times_s.size() > 1) {
    exposure.left_sub_frames = sub_frames(time_s);
    exposure.right_sub_frames = offset_s == 0 ? exposure.left_sub_frames : sub_frames(time_s + offset_s);
    for (SubFrame& sub : exposure.right_sub_frames)
      sub.T_world_camera = sub.T_world_camera * T_left_right_now;
  }

  tell_expected_motion(exposure);
  return exposure;
}

/// What the robot knows: its odometry, its plan, and the motion that either makes it expect.
void Simulation::Wheeled::tell_expected_motion(Exposure& exposure) {
  // copies read the encoders at the exposure
  const double time_s = static_cast<double>(exposure.stamp_ns) * 1e-9;
  WheelAngles angles_now = angles;
  angles_now.update(rolled_rad(*exposure.state), wheel_faults(drive_errors, faults, time_s));
  Odometry reading = odometry;
  reading.update(angles_now.counted_rad(0), angles_now.counted_rad(1));
  exposure.T_odom_body = to_pose(reading.T_odom_body());
  T_odom_body_at.push_back(reading.T_odom_body());

  const Pose2 planned = path.at(time_s).T_world_body;
  exposure.T_plan_body = to_pose(composed(kidnapping.T_world_plan(), planned));
  const Pose2 expected =
      feedback == Feedback::kOdometry ? composed(T_world_start, reading.T_odom_body()) : planned;
  const slam::Pose T_world_now = to_pose(expected) * planned_T_body_left(time_s);
  exposure.T_previous_left =
      exposure.index == 0 ? slam::Pose::Identity() : T_world_expected_left.inverse() * T_world_now;
  T_world_expected_left = T_world_now;
}

std::optional<Exposure> Simulation::Wheeled::advance() {
  if (next_exposure >= exposures) return std::nullopt;
  return expose();
}

Simulation::Simulation(const World& world, const HeadModel& head, const Scenario& scenario,
                       PoseFeedback core_pose) {
  if (scenario.plan.is_for_arm()) {
    carrier_ = std::make_unique<ArmSimulation>(world, head, scenario);
  } else {
    carrier_ = std::make_unique<Wheeled>(world, head, scenario, std::move(core_pose));
  }
}
Simulation::~Simulation() = default;

std::optional<Exposure> Simulation::advance() { return carrier_->advance(); }
int64_t Simulation::exposures() const { return carrier_->exposure_count(); }
double Simulation::planned_length_m() const { return carrier_->planned_length_m(); }
slam::Pose Simulation::planned_T_world_body(double time_s) const {
  return carrier_->planned_T_world_body(time_s);
}
double Simulation::planned_duration_s() const { return carrier_->planned_duration_s(); }

}  // namespace groundloop::sim
