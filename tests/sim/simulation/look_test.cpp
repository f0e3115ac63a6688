#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "sim/simulation/simulation.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The Pioneer with a pan-tilt head on a bare floor.
Scenario looking(const std::string& segments, double look_speed_degps = 30) {
  Scenario scenario =
      pioneer_in(write_world("look", kFloor), "  speed_mps: 0.2\n  segments: [" + segments + "]\n");
  scenario.robot.model = std::filesystem::absolute("models/robots/p3dx_pan_tilt.xml").string();
  scenario.plan.look_speed_degps = look_speed_degps;
  return scenario;
}

struct Drive {
  explicit Drive(const Scenario& scenario)
      : world(World::load(scenario)), head(load_head(scenario.head.model)) {
    Simulation simulation(world, head, scenario);
    while (auto exposure = simulation.advance()) exposures.push_back(std::move(*exposure));
  }
  World world;
  HeadModel head;
  std::vector<Exposure> exposures;
};

/// The left camera of a head that turns about a vertical axis above (0.035, 0), then about a level one at the
/// height of 0.35 m.
slam::Pose expected_T_body_left(double pan_deg, double tilt_deg) {
  const Eigen::Translation3d to_axes(0.035, 0, 0.35);
  const Eigen::AngleAxisd pan(pan_deg * kDegree, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd tilt(-tilt_deg * kDegree, Eigen::Vector3d::UnitY());
  return to_axes * pan * tilt * slam::StereoRig::level_camera({0.045, 0.044, 0});
}

void expect_near(const slam::Pose& a, const slam::Pose& b, double trans_m, double rot_deg) {
  const slam::Pose difference = a.inverse() * b;
  EXPECT_LT(difference.translation().norm(), trans_m);
  EXPECT_LT(slam::rotation_angle_rad(difference.linear()), rot_deg * kDegree);
}

TEST(Look, TheServosBringTheHeadWhereItIsToLook) {
  const Drive drive(
      looking("{look: {pan_deg: 50}}, {stop_s: 1}, {look: {pan_deg: -30, tilt_deg: 15}}, {stop_s: 1}"));
  const auto T_body_left = [&](const Exposure& e) { return e.T_world_body.inverse() * e.T_world_left; };
  expect_near(T_body_left(drive.exposures.front()), drive.head.rig().T_body_left, 1e-4, 0.01);
  expect_near(T_body_left(drive.exposures.back()), expected_T_body_left(-30, 15), 5e-4, 0.1);
  double most_left_deg = 0;
  for (const Exposure& exposure : drive.exposures) {
    const Eigen::Vector3d ahead = T_body_left(exposure).linear().col(2);
    most_left_deg = std::max(most_left_deg, std::atan2(ahead.y(), ahead.x()) / kDegree);
    // the robot stands, but for what its turning head makes it sway
    ASSERT_LT(exposure.T_world_body.translation().head<2>().norm(), 0.001);
  }
  EXPECT_NEAR(most_left_deg, 50, 0.1);
}

TEST(Look, BothCamerasTurnAsOne) {
  const Drive drive(looking("{look: {pan_deg: 70, tilt_deg: -20}}"));
  for (const Exposure& exposure : drive.exposures) {
    const slam::Pose T_left_right = exposure.T_world_left.inverse() * exposure.T_world_right;
    expect_near(T_left_right, slam::Pose(Eigen::Translation3d(0.088, 0, 0)), 1e-9, 1e-6);
  }
}

TEST(Look, ThePlannedMotionAddsUpToTheTruth) {
  const Drive drive(
      looking("{look: {pan_deg: 60}}, {straight_m: 0.3}, {look: {pan_deg: -60, tilt_deg: 10}}, "
              "{arc: {radius_m: 0.5, angle_deg: 30}}, {look: {pan_deg: 0}}, {stop_s: 0.5}"));
  slam::Pose T_first_left = slam::Pose::Identity();
  for (const Exposure& exposure : drive.exposures) {
    T_first_left = T_first_left * exposure.T_previous_left;
    const slam::Pose truth = drive.exposures.front().T_world_left.inverse() * exposure.T_world_left;
    expect_near(T_first_left, truth, 0.004, 0.6);
  }
  EXPECT_NEAR(T_first_left.translation().norm(), 0.5, 0.1);  // it was a drive
}

std::string refusal(const Scenario& scenario) {
  const World world = World::load(scenario);
  try {
    const Simulation simulation(world, load_head(scenario.head.model), scenario);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Look, BeyondTheJointsIsRefused) {
  const Scenario scenario = looking("{look: {pan_deg: 130}}, {look: {pan_deg: 120, tilt_deg: -46}}");
  EXPECT_EQ(
      refusal(scenario),
      scenario.file +
          ":8: plan.segments[0].look.pan_deg: 130: wanted -120 to 120, what the robot's joint can do\n" +
          scenario.file +
          ":8: plan.segments[1].look.tilt_deg: -46: wanted -45 to 45, what the robot's joint can do");
}

TEST(Look, ARobotWithoutAPanTiltHeadIsRefused) {
  Scenario scenario = looking("{stop_s: 1}, {look: {pan_deg: 30}}");
  scenario.robot.model = std::filesystem::absolute("models/robots/p3dx.xml").string();
  EXPECT_EQ(refusal(scenario), scenario.file + ":8: plan.segments[1].look: " + scenario.robot.model +
                                   ": wanted a robot with a pan-tilt head (p3dx_pan_tilt.xml is one)");
}

}  // namespace
}  // namespace groundloop::sim
