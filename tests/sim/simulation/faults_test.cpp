// Faults that change what happens: slip, encoders, kidnapping, knocks and trigger offset in the physics.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/robot/pose2.h"
#include "sim/simulation/simulation.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct FaultyDrive {
  Scenario scenario;
  World world;
  HeadModel head;
  Simulation simulation;
  std::vector<Exposure> exposures;

  FaultyDrive(const std::string& plan, const std::string& faults)
      : scenario(pioneer_in(write_world("faults", kFloor), plan + "faults:\n" + faults)),
        world(World::load(scenario)),
        head(load_head(scenario.head.model)),
        simulation(world, head, scenario) {
    while (auto exposure = simulation.advance()) exposures.push_back(std::move(*exposure));
  }
  const Exposure& last() const { return exposures.back(); }
  Pose2 end() const { return to_pose2(last().T_world_body); }
};

const std::string kStraight = "  speed_mps: 0.3\n  segments: [{straight_m: 0.9}, {stop_s: 0.5}]\n";

TEST(Slip, BothWheelsSlippingShortenTheWayButNotTheOdometry) {
  const FaultyDrive drive(kStraight, "  - {at_s: 0, wheel_slip: {left: 0.4, right: 0.4}}\n");
  EXPECT_NEAR(drive.end().x_m, 0.6 * 0.9, 0.002);
  EXPECT_NEAR(drive.last().T_odom_body.translation().x(), 0.9, 0.02) << "the encoders turn with the motors";
}

TEST(Slip, OneWheelSlippingTurnsTheRobotByItsPart) {
  const FaultyDrive drive(kStraight, "  - {at_s: 0, wheel_slip: {left: 0.1}}\n");
  EXPECT_NEAR(drive.end().yaw_rad, 0.1 * 0.9 / 0.33, 0.5 * kDegree)
      << "to the left, where the way is shorter";
}

TEST(Slip, ActsOnlyWhileItLasts) {
  const FaultyDrive drive(kStraight, "  - {at_s: 1, for_s: 1, wheel_slip: {left: 0.5, right: 0.5}}\n");
  EXPECT_NEAR(drive.end().x_m, 0.9 - 0.5 * 0.3, 0.01) << "half of one second at 0.3 m/s is missing";
}

TEST(Encoder, ADeadEncoderBendsTheOdometryNotTheDrive) {
  const FaultyDrive drive(kStraight, "  - {at_s: 0, encoder: {right: 0}}\n");
  EXPECT_NEAR(drive.end().x_m, 0.9, 0.002);
  EXPECT_NEAR(drive.end().yaw_rad, 0, 0.1 * kDegree);
  const Pose2 odometry = to_pose2(drive.last().T_odom_body);
  EXPECT_NEAR(wrapped(odometry.yaw_rad + 0.9 / 0.33), 0, 6 * kDegree) << "it sees the left wheel run round";
}

TEST(Kidnap, ThePlanGoesOnFromTheNewPlace) {
  const FaultyDrive drive(
      "  speed_mps: 0.3\n  segments: [{straight_m: 0.9}, {arc: {radius_m: 0.5, angle_deg: 90}}, {stop_s: "
      "0.5}]\n",
      "  - {at_s: 1.5, kidnap: {x_m: 5, y_m: -3, yaw_deg: 90}}\n");
  // what the plan still has to do, seen from where it was interrupted
  const Pose2 from = to_pose2(drive.simulation.planned_T_world_body(1.5));
  const Pose2 rest = composed(
      inverse(from), to_pose2(drive.simulation.planned_T_world_body(drive.simulation.planned_duration_s())));
  const Pose2 expected = composed({5, -3, 90 * kDegree}, rest);
  EXPECT_NEAR(drive.end().x_m, expected.x_m, 0.01);
  EXPECT_NEAR(drive.end().y_m, expected.y_m, 0.01);
  EXPECT_NEAR(wrapped(drive.end().yaw_rad - expected.yaw_rad), 0, 0.5 * kDegree);
  EXPECT_LT((drive.last().T_plan_body.translation() - drive.last().T_world_body.translation()).norm(), 0.01);
}

TEST(Kidnap, NothingTheRobotKnowsShowsIt) {
  const std::string kidnap = "  - {at_s: 1.5, kidnap: {x_m: 5, y_m: -3, yaw_deg: 90}}\n";
  const FaultyDrive kidnapped(kStraight, kidnap), left_alone(kStraight, "  []\n");
  ASSERT_EQ(kidnapped.exposures.size(), left_alone.exposures.size());
  for (size_t i = 0; i < kidnapped.exposures.size(); ++i) {
    const Exposure &a = kidnapped.exposures[i], &b = left_alone.exposures[i];
    const double moved_m = (a.T_world_body.translation() - b.T_world_body.translation()).norm();
    EXPECT_EQ(moved_m > 1, a.stamp_ns >= 1'500'000'000) << i << ": from the first exposure on";
    EXPECT_TRUE(a.T_previous_left.isApprox(b.T_previous_left, 1e-12)) << i;
    EXPECT_LT((a.T_odom_body.translation() - b.T_odom_body.translation()).norm(), 1e-4) << i;
    EXPECT_LT(std::abs(a.T_world_body.translation().z()), 0.001) << i << ": it stands on the floor";
  }
}

TEST(Kidnap, SteeredByTruthItFollowsThePlanFromThere) {
  const FaultyDrive drive(
      "  feedback: truth\n  speed_mps: 0.3\n  segments: [{straight_m: 0.9}, {stop_s: 0.5}]\n",
      "  - {at_s: 1.5, kidnap: {x_m: 0, y_m: 4, yaw_deg: 180}}\n");
  const double driven_m = drive.simulation.planned_T_world_body(1.5).translation().x();
  EXPECT_NEAR(drive.end().x_m, -(0.9 - driven_m), 0.005);
  EXPECT_NEAR(drive.end().y_m, 4, 0.005);
}

TEST(TriggerOffset, TheRightCameraSeesTheWorldOfItsOwnTime) {
  const FaultyDrive drive(kStraight, "  - {at_s: 1, for_s: 1, trigger_offset: {right_s: 0.02}}\n");
  for (const Exposure& exposure : drive.exposures) {
    const bool struck = exposure.stamp_ns >= 1'000'000'000 && exposure.stamp_ns < 2'000'000'000;
    EXPECT_EQ(exposure.state_right != exposure.state, struck) << exposure.index;
    const Eigen::Vector3d p_left_right =
        exposure.T_world_left.inverse() * exposure.T_world_right.translation();
    EXPECT_NEAR(p_left_right.x(), 0.088, 1e-4);
    EXPECT_NEAR(p_left_right.z(), struck ? 0.02 * 0.3 : 0, 2e-4) << "farther on by 20 ms of the drive";
  }
}

TEST(Knock, TurnsTheRightCameraOnly) {
  const FaultyDrive drive(kStraight, "  - {at_s: 1, knock: {pan_deg: 2}}\n");
  const Exposure& before = drive.exposures.front();
  EXPECT_TRUE(before.T_world_right.linear().isApprox(before.T_world_left.linear(), 1e-12));
  const Exposure& after = drive.last();
  const Eigen::Vector3d forward_left =
      after.T_world_left.linear().transpose() * after.T_world_right.linear().col(2);
  EXPECT_NEAR(forward_left.x(), -std::sin(2 * kDegree), 1e-9) << "to the left";
  EXPECT_NEAR((after.T_world_left.inverse() * after.T_world_right.translation()).x(), 0.088, 1e-9);
}

}  // namespace
}  // namespace groundloop::sim
