#include "sim/simulation/arm_simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "sim/arm/camera_stops.h"
#include "sim/simulation/carried_head.h"
#include "tests/sim/arm/test_arm.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
const char* const kDrive =
    "{speed_mps: 0.1, path: {z_m: 0.2, tilt_deg: 5, step_m: 0.05, step_deg: 8, drive: {x_m: 0.3, y_m: 0.35, "
    "yaw_deg: -20, pieces: "
    "[{straight_m: 0.1}, {arc: {radius_m: 0.3, angle_deg: -40}}]}}}";

class ArmSimulationTest : public ::testing::Test {
 protected:
  Scenario scenario = arm_among("simulation", "", kDrive);

  std::vector<Exposure> run() const {
    const World world = World::load(scenario);
    Simulation simulation(world, carried_head(scenario), scenario);
    std::vector<Exposure> exposures;
    while (auto exposure = simulation.advance()) {
      exposure->state.reset();
      exposure->state_right.reset();
      exposures.push_back(*exposure);
    }
    EXPECT_EQ(exposures.size(), static_cast<size_t>(simulation.exposures()));
    return exposures;
  }
  static slam::Pose T_left_right(const Exposure& exposure) {
    return exposure.T_world_left.inverse() * exposure.T_world_right;
  }
};

TEST_F(ArmSimulationTest, WithoutErrorsTheCameraStandsWhereItIsPlannedAndTheBaselineIsExact) {
  const auto stops = camera_stops(scenario, 2'000'000'000);
  const std::vector<Exposure> exposures = run();
  ASSERT_EQ(exposures.size(), stops.size());
  for (size_t i = 0; i < stops.size(); ++i) {
    EXPECT_EQ(exposures[i].stamp_ns, static_cast<int64_t>(i) * 2'000'000'000);
    // six joints, each within 2 microradians, at arm's length
    const slam::Vector6d off = slam::se3_log(stops[i].T_world_left.inverse() * exposures[i].T_world_left);
    EXPECT_LT(off.norm(), 1e-5);
    const slam::Pose pair = T_left_right(exposures[i]);
    EXPECT_NEAR(pair.translation().x(), 0.02, 5e-6);
    EXPECT_NEAR(pair.translation().y(), 0, 5e-6);
    EXPECT_NEAR(pair.translation().z(), 0, 5e-6);
    EXPECT_LT(slam::rotation_angle_rad(pair.linear()), 1e-5);
  }
}

TEST_F(ArmSimulationTest, TheCoreIsToldThePlanAndTheMapLiesOnTheTable) {
  scenario.robot.arm.repeatability_m = 2e-4;
  const auto stops = camera_stops(scenario, 2'000'000'000);
  const std::vector<Exposure> exposures = run();
  for (size_t i = 1; i < stops.size(); ++i) {
    const slam::Pose planned = stops[i - 1].T_world_left.inverse() * stops[i].T_world_left;
    EXPECT_TRUE(exposures[i].T_previous_left.isApprox(planned, 1e-12));
  }
  // the body: below the camera, heading where it looks
  const slam::Pose T_body_left = carried_head(scenario).rig().T_body_left;
  EXPECT_NEAR(T_body_left.translation().z(), 0.2, 1e-12);
  const slam::Pose T_world_body = stops[0].T_world_left * T_body_left.inverse();
  EXPECT_LT((T_world_body.translation() - Eigen::Vector3d(0.3, 0.35, 0)).norm(), 1e-12);
  EXPECT_NEAR(slam::yaw_rad(T_world_body.linear()), -20 * kDegree, 1e-12);
  EXPECT_NEAR(T_world_body.linear()(2, 2), 1, 1e-12);
  EXPECT_TRUE(exposures[0].T_plan_body.isApprox(T_world_body, 1e-12));
}

TEST_F(ArmSimulationTest, AHandEyeErrorIsTheSameAtEveryStop) {
  scenario.robot.arm.hand_eye = {.x_m = 0.002, .z_m = -0.001, .pan_deg = 0.5, .roll_deg = -0.3};
  const auto stops = camera_stops(scenario, 2'000'000'000);
  const std::vector<Exposure> exposures = run();
  for (size_t i = 0; i < stops.size(); ++i) {
    const slam::Pose error = stops[i].T_world_left.inverse() * exposures[i].T_world_left;
    EXPECT_NEAR(error.translation().x(), 0.002, 1e-5);
    EXPECT_NEAR(error.translation().z(), -0.001, 1e-5);
    EXPECT_NEAR(slam::rotation_angle_rad(error.linear()), std::hypot(0.5, 0.3) * kDegree, 2e-5);
    // the hand moves along the x axis that it believes in: the pair is toed in by nothing, but not along its
    // own rows
    const slam::Pose pair = T_left_right(exposures[i]);
    EXPECT_NEAR(pair.translation().norm(), 0.02, 5e-6);
    EXPECT_NEAR(pair.translation().y(), 0.02 * std::sin(0.3 * kDegree), 5e-6);
    EXPECT_LT(slam::rotation_angle_rad(pair.linear()), 1e-5);
  }
}

TEST_F(ArmSimulationTest, RepeatabilityShowsInEveryStopAndFollowsTheSeed) {
  scenario.robot.arm.repeatability_m = 1e-4;
  const std::vector<Exposure> exposures = run(), again = run();
  double sum2 = 0;
  for (size_t i = 0; i < exposures.size(); ++i) {
    EXPECT_TRUE(exposures[i].T_world_left.isApprox(again[i].T_world_left, 0));
    sum2 += std::pow(T_left_right(exposures[i]).translation().x() - 0.02, 2);
  }
  // two stops a pair: sqrt(2) times the standard deviation of one; 9 pairs tell it to about a quarter
  const double sigma_m = std::sqrt(sum2 / static_cast<double>(exposures.size()));
  EXPECT_GT(sigma_m, 0.5e-4);
  EXPECT_LT(sigma_m, 2.6e-4);
  scenario.seed = 2;
  EXPECT_FALSE(run()[0].T_world_left.isApprox(exposures[0].T_world_left, 1e-7));
}

TEST_F(ArmSimulationTest, PairsBetweenTwoPosesAreTakenAtTheFirst) {
  scenario = arm_among(
      "waiting", "",
      "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}, {x_m: 0.42, y_m: 0, z_m: 0.2, at_s: 6}]}");
  const std::vector<Exposure> exposures = run();
  ASSERT_EQ(exposures.size(), 4U);
  EXPECT_NEAR(exposures[2].T_world_left.translation().x(), 0.4, 1e-5);
  EXPECT_TRUE(exposures[2].T_previous_left.isApprox(slam::Pose::Identity(), 1e-12));
  EXPECT_NEAR(exposures[3].T_world_left.translation().x(), 0.42, 1e-5);
}

TEST_F(ArmSimulationTest, AnArmThatIsTooSlowForTheHeadIsNamed) {
  scenario = arm_among(
      "slow", "", "{speed_mps: 0.02, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}, {x_m: 0.4, y_m: 0.3, z_m: 0.2}]}");
  const auto problems = problems_of([&] { run(); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].text(),
              HasSubstr("plan.poses[1]: x 0.400 m, y 0.300 m, z 0.200 m: the arm moves for "));
  EXPECT_THAT(
      problems[0].text(),
      HasSubstr("to be there twice: wanted 1.50 s at most: the head's time between pairs, less 0.25 s"));
}

TEST_F(ArmSimulationTest, WhatOnlyARobotOnWheelsCanDoIsRefused) {
  const std::string file = scenario.file;
  const auto problems = problems_of([&] {
    load_scenario(file,
                  {{"plan.feedback", "truth"}, {"faults", "[{at_s: 1, for_s: 1, wheel_slip: {left: 0.2}}]"}});
  });
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_THAT(problems[1].text(), HasSubstr("wanted an arm, which follows its plan"));
  EXPECT_THAT(problems[0].text(), HasSubstr("wanted faults that one camera on an arm can suffer"));
}

/// What scenarios/arm_reach.yaml promises of poses near to its own.
TEST_F(ArmSimulationTest, BeyondTheLimitOfItsReachStopsAreRefusedBeforeTheRun) {
  const auto problems_at = [](double radius_m) {
    Scenario reach = load_scenario("scenarios/arm_reach.yaml");
    reach.plan.path.reset();
    for (const double angle_deg : {-60.0, -59.3, -58.6}) {
      CameraPose pose;
      pose.x_m = radius_m * std::cos(angle_deg * kDegree);
      pose.y_m = radius_m * std::sin(angle_deg * kDegree);
      pose.z_m = 0.3;
      pose.yaw_deg = angle_deg + 70;
      reach.plan.poses.push_back(pose);
    }
    const World world = World::load(reach, Looks::kNone);
    return problems_of([&] { Simulation(world, carried_head(reach), reach).exposures(); });
  };
  EXPECT_TRUE(problems_at(0.80).empty());
  const auto slow = problems_at(0.865);
  ASSERT_FALSE(slow.empty());
  EXPECT_THAT(slow[0].text(), HasSubstr("plan.poses[1]: "));
  EXPECT_THAT(slow[0].text(), HasSubstr("the arm moves for "));
  const auto far = problems_at(0.93);
  ASSERT_EQ(far.size(), 3U);
  for (const Problem& problem : far) EXPECT_THAT(problem.text(), HasSubstr("mm beyond the arm's reach"));
}

/// Everything so many times as large: the same angles, places times the factor.
TEST_F(ArmSimulationTest, ALargerScenarioIsTheSameInAnotherUnit) {
  const std::vector<Exposure> small = run();
  scenario.scale = 4.4;
  const std::vector<Exposure> large = run();
  EXPECT_NEAR(carried_head(scenario).baseline_m, 0.088, 1e-12);
  EXPECT_NEAR(carried_head(scenario).mount.z_m, 0.88, 1e-12);
  ASSERT_EQ(small.size(), large.size());
  for (size_t i = 0; i < small.size(); ++i) {
    EXPECT_LT((small[i].T_world_left.translation() * 4.4 - large[i].T_world_left.translation()).norm(), 5e-5);
    EXPECT_TRUE(small[i].T_world_left.linear().isApprox(large[i].T_world_left.linear(), 1e-5));
  }
}

}  // namespace
}  // namespace groundloop::sim
