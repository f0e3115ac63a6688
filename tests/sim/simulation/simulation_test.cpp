#include "sim/simulation/simulation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/robot/pose2.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

struct Drive {
  World world;
  HeadModel head;
  Simulation simulation;
  std::vector<Exposure> exposures;

  explicit Drive(const Scenario& scenario, double rate_hz = 7.5)
      : world(World::load(scenario)), head(head_at(scenario, rate_hz)), simulation(world, head, scenario) {
    while (auto exposure = simulation.advance()) exposures.push_back(std::move(*exposure));
  }
  static HeadModel head_at(const Scenario& scenario, double rate_hz) {
    HeadModel head = load_head(scenario.head.model);
    head.rate_hz = rate_hz;
    return head;
  }
  const Exposure& last() const { return exposures.back(); }
};

Scenario on_the_floor(const std::string& plan) { return pioneer_in(write_world("floor", kFloor), plan); }

/// Where the robot is, seen from where it should be.
Pose2 deviation(const Exposure& exposure) {
  return to_pose2(exposure.T_plan_body.inverse() * exposure.T_world_body);
}
double distance_m(const Pose2& pose) { return std::hypot(pose.x_m, pose.y_m); }

TEST(Simulation, DrivesAStraightOnWheels) {
  const Drive drive(on_the_floor("  speed_mps: 0.2\n  segments: [{straight_m: 2}, {stop_s: 0.5}]\n"));
  EXPECT_NEAR(drive.last().T_plan_body.translation().x(), 2, 1e-9);
  EXPECT_NEAR(drive.last().T_world_body.translation().x(), 2, 0.001);
  for (const Exposure& exposure : drive.exposures) {
    ASSERT_LT(distance_m(deviation(exposure)), 0.002) << exposure.index;
    ASSERT_LT(std::abs(deviation(exposure).yaw_rad), 0.02 * kDegree) << exposure.index;
  }
}

TEST(Simulation, DrivesAnArcAndTurnsOnTheSpot) {
  const Drive drive(
      on_the_floor("  speed_mps: 0.2\n  segments: [{arc: {radius_m: 1, angle_deg: 90}}, {arc: {radius_m: 0, "
                   "angle_deg: -90}}, "
                   "{stop_s: 0.5}]\n"));
  const Pose2 end = to_pose2(drive.last().T_world_body);
  EXPECT_NEAR(end.x_m, 1, 0.003);
  EXPECT_NEAR(end.y_m, 1, 0.003);
  EXPECT_NEAR(end.yaw_rad, 0, 0.2 * kDegree);
  for (const Exposure& exposure : drive.exposures) {
    ASSERT_LT(distance_m(deviation(exposure)), 0.003) << exposure.index;
    ASSERT_LT(std::abs(deviation(exposure).yaw_rad), 0.4 * kDegree) << exposure.index;
  }
}

/// The moments of an exposure are where the drive is at their times; the right camera's are its own.
TEST(Simulation, AHeadThatTakesTimeSeesTheSceneGoBy) {
  const Scenario scenario = on_the_floor("  speed_mps: 0.3\n  segments: [{straight_m: 1.2}]\n");
  const World world = World::load(scenario);
  HeadModel head = load_head(scenario.head.model);
  head.raw.emplace();
  head.raw->exposure.time_s = 0.01;
  head.raw->exposure.readout_s = 0.03;
  head.raw->exposure.sub_frames = 5;
  head.raw->exposure.right_trigger_offset_s = 0.008;
  head.raw->right_pose.pan_deg = 1;
  Simulation simulation(world, head, scenario);
  for (int i = 0; i < 15; ++i) simulation.advance();
  const Exposure exposure = simulation.advance().value();
  ASSERT_EQ(exposure.left_sub_frames.size(), 5U);
  ASSERT_EQ(exposure.right_sub_frames.size(), 5U);
  for (size_t k = 0; k < 5; ++k) {
    const double t_s = head.sub_frame_times_s()[k];
    const slam::Pose T_left_sub =
        exposure.T_world_left.inverse() * exposure.left_sub_frames[k].T_world_camera;
    EXPECT_NEAR(T_left_sub.translation().z(), 0.3 * t_s, 1e-4) << k;
    EXPECT_NEAR(exposure.left_sub_frames[k].state->time, 1e-9 * static_cast<double>(exposure.stamp_ns) + t_s,
                1e-9);
    const slam::Pose T_left_right =
        exposure.left_sub_frames[k].T_world_camera.inverse() * exposure.right_sub_frames[k].T_world_camera;
    EXPECT_NEAR((T_left_right.translation() - head.T_left_right().translation()).z(), 0.3 * 0.008, 1e-4) << k;
    EXPECT_TRUE(T_left_right.linear().isApprox(head.T_left_right().linear(), 1e-3));
  }
  EXPECT_TRUE(exposure.left_sub_frames[2].T_world_camera.isApprox(exposure.T_world_left, 1e-12));
}

TEST(Simulation, StandsOnTheFloorAndStaysLevel) {
  const Drive drive(on_the_floor(
      "  speed_mps: 0.3\n  segments: [{straight_m: 1}, {arc: {radius_m: 0.5, angle_deg: 60}}]\n"));
  for (const Exposure& exposure : drive.exposures) {
    ASSERT_NEAR(exposure.T_world_body.translation().z(), 0, 0.0005);
    ASSERT_LT(std::acos(std::min(1.0, exposure.T_world_body.linear()(2, 2))), 0.1 * kDegree);
  }
}

TEST(Simulation, ExposuresAreAtExactTimesAndAsManyAsThePlanLasts) {
  const Drive drive(on_the_floor("  speed_mps: 0.2\n  segments: [{straight_m: 0.2}, {stop_s: 0.3}]\n"));
  const double duration_s = drive.simulation.planned_duration_s();
  EXPECT_EQ(drive.simulation.exposures(), static_cast<int64_t>(std::floor(duration_s * 7.5)) + 1);
  ASSERT_EQ(drive.exposures.size(), static_cast<size_t>(drive.simulation.exposures()));
  for (size_t i = 0; i < drive.exposures.size(); ++i) {
    EXPECT_EQ(drive.exposures[i].index, static_cast<int64_t>(i));
    EXPECT_EQ(drive.exposures[i].stamp_ns, static_cast<int64_t>(i) * drive.head.period_ns());
  }
  EXPECT_NEAR(drive.simulation.planned_length_m(), 0.2, 1e-12);
}

TEST(Simulation, StateAndTruthAreTheSame) {
  const Drive drive(on_the_floor("  speed_mps: 0.2\n  segments: [{arc: {radius_m: 0.5, angle_deg: 40}}]\n"));
  for (const Exposure& exposure : drive.exposures) {
    const Eigen::Vector3d drawn =
        Eigen::Map<const Eigen::Vector3d>(exposure.state->xpos + 3 * drive.world.robot_body());
    ASSERT_EQ((drawn - exposure.T_world_body.translation()).norm(), 0) << "what is drawn is what is true";
    ASSERT_TRUE(exposure.T_world_left.isApprox(exposure.T_world_body * drive.head.rig().T_body_left, 1e-12));
    const Eigen::Vector3d p_left_right =
        exposure.T_world_left.inverse() * exposure.T_world_right.translation();
    ASSERT_TRUE(p_left_right.isApprox(Eigen::Vector3d(0.088, 0, 0), 1e-9));
    ASSERT_TRUE(exposure.T_world_right.linear().isApprox(exposure.T_world_left.linear(), 1e-12));
  }
}

TEST(Simulation, TheCoreIsToldThePlannedMotionNotTheTruth) {
  const Drive drive(on_the_floor(
      "  speed_mps: 0.2\n  segments: [{straight_m: 0.3}, {arc: {radius_m: 0.5, angle_deg: 40}}]\n"));
  EXPECT_TRUE(drive.exposures[0].T_previous_left.isApprox(slam::Pose::Identity()));
  const slam::Pose T_body_left = drive.head.rig().T_body_left;
  for (size_t i = 1; i < drive.exposures.size(); ++i) {
    const slam::Pose planned = (drive.exposures[i - 1].T_plan_body * T_body_left).inverse() *
                               drive.exposures[i].T_plan_body * T_body_left;
    ASSERT_TRUE(drive.exposures[i].T_previous_left.isApprox(planned, 1e-12)) << i;
  }
}

TEST(Simulation, TheDriveDoesNotDependOnTheHead) {
  const std::string plan =
      "  speed_mps: 0.2\n  segments: [{straight_m: 0.2}, {arc: {radius_m: 0.5, angle_deg: 20}}]\n";
  const Drive slow(on_the_floor(plan), 10), fast(on_the_floor(plan), 20);
  for (size_t i = 0; i < slow.exposures.size(); ++i) {
    ASSERT_EQ(fast.exposures[2 * i].stamp_ns, slow.exposures[i].stamp_ns);
    ASSERT_EQ(fast.exposures[2 * i].T_world_left.matrix(), slow.exposures[i].T_world_left.matrix());
  }
}

TEST(Simulation, TwoRunsAreTheSameToTheLastBit) {
  const std::string plan =
      "  speed_mps: 0.2\n  feedback: odometry\n  segments: [{arc: {radius_m: 0.5, angle_deg: 60}}]\n";
  const Drive a(on_the_floor(plan)), b(on_the_floor(plan));
  ASSERT_EQ(a.exposures.size(), b.exposures.size());
  for (size_t i = 0; i < a.exposures.size(); ++i) {
    ASSERT_EQ(a.exposures[i].T_world_left.matrix(), b.exposures[i].T_world_left.matrix()) << i;
    ASSERT_EQ(a.exposures[i].T_odom_body.matrix(), b.exposures[i].T_odom_body.matrix()) << i;
  }
}

TEST(Simulation, TheSeedMovesOdometryOnlyUntilOdometrySteers) {
  Scenario scenario = on_the_floor("  speed_mps: 0.3\n  segments: [{straight_m: 1}]\n");
  const Drive one(scenario);
  scenario.seed = 2;
  const Drive two(scenario);
  EXPECT_EQ(one.last().T_world_body.matrix(), two.last().T_world_body.matrix());
  EXPECT_NE(one.last().T_odom_body.matrix(), two.last().T_odom_body.matrix());
}

TEST(Simulation, SteeredByTruthItStaysOnThePlan) {
  const Drive drive(
      on_the_floor("  speed_mps: 0.3\n  feedback: truth\n  segments: [{straight_m: 1}, {arc: {radius_m: 1, "
                   "angle_deg: -90}}, {stop_s: 1}]\n"));
  EXPECT_LT(distance_m(deviation(drive.last())), 0.002);
  EXPECT_LT(std::abs(deviation(drive.last()).yaw_rad), 0.1 * kDegree);
}

/// UMBmark on the physics: the robot drives a square that its odometry sees closed.
Pose2 square_end(double side_m, int sign) {
  Scenario scenario =
      on_the_floor("  speed_mps: 0.4\n  turn_rate_limit_degps: 45\n  segments: [{stop_s: 0}]\n");
  scenario.plan.feedback = Feedback::kOdometry;
  scenario.plan.segments.clear();
  for (int corner = 0; corner < 4; ++corner) {
    Segment side, turn;
    side.straight_m = side_m;
    turn.arc = ArcSegment{0, sign * 90.0};
    scenario.plan.segments.insert(scenario.plan.segments.end(), {side, turn});
  }
  scenario.robot.odometry.noise_m_per_sqrt_m = 0;
  const Drive drive(scenario, 1);
  EXPECT_LT(distance_m(to_pose2(drive.last().T_odom_body)), 0.01) << "the odometry sees a closed square";
  return to_pose2(drive.last().T_world_body);
}

TEST(Simulation, UmbmarkRecoversTheOdometrysErrors) {
  const double L = 2, track_m = 0.33;
  const double x_ccw = square_end(L, 1).x_m, x_cw = square_end(L, -1).x_m;
  const double alpha_rad = (x_cw + x_ccw) / (-4 * L), beta_rad = (x_cw - x_ccw) / (-4 * L);
  const double R = (L / 2) / std::sin(beta_rad / 2);
  EXPECT_NEAR((R + track_m / 2) / (R - track_m / 2), 1.002, 0.0004) << "E_d";
  EXPECT_NEAR((std::numbers::pi / 2) / (std::numbers::pi / 2 - alpha_rad), 1.02, 0.003) << "E_b";
}

TEST(Simulation, WithoutALevelFloorItSaysSo) {
  const Scenario scenario = pioneer_in(write_world("pit", "<geom type='box' size='1 1 0.1' pos='0 0 -1'/>"),
                                       "  speed_mps: 0.2\n  segments: [{straight_m: 1}]\n");
  const World world = World::load(scenario);
  try {
    const Simulation simulation(world, load_head(scenario.head.model), scenario);
    FAIL() << "a start above a pit was accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("robot.start: the robot moves by "));
    EXPECT_THAT(e.what(), HasSubstr("m when it is put there: wanted a level floor at z = 0 under the robot"));
  }
}

TEST(Simulation, CoarsePhysicsIsRefused) {
  std::ifstream in("models/robots/p3dx.xml");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.replace(text.find("timestep=\"0.002\""), 16, "timestep=\"0.01\"");
  const auto folder = std::filesystem::temp_directory_path() / "groundloop_simulation_coarse";
  std::filesystem::create_directories(folder);
  std::filesystem::copy(
      "models/robots/p3dx", folder / "p3dx",  // what it includes
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  const auto coarse = folder / "p3dx.xml";
  std::ofstream(coarse) << text;

  Scenario scenario = on_the_floor("  speed_mps: 0.2\n  segments: [{straight_m: 1}]\n");
  scenario.robot.model = coarse.string();
  const World world = World::load(scenario);
  try {
    const Simulation simulation(world, load_head(scenario.head.model), scenario);
    FAIL() << "steps of 10 ms were accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.what(), coarse.string() + ": option.timestep: 0.01: wanted a physics step of 2 ms or less");
  }
}

}  // namespace
}  // namespace groundloop::sim
