#include "sim/arm/arm_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "sim/arm/arm_clearance.h"
#include "tests/sim/arm/test_arm.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kBaseline_m = 0.02;
constexpr int64_t kPeriod_ns = 20'000'000'000;  // time enough for ways across the table

ArmPlan plan_of(const Scenario& scenario) {
  const World world = World::load(scenario);
  return plan_arm(scenario, world, find_arm(world, scenario.robot.model), kBaseline_m, kPeriod_ns);
}

std::vector<Problem> problems_with(const std::string& geoms, const std::string& plan) {
  const Scenario scenario = arm_among("plan", geoms, plan);
  return problems_of([&] { plan_of(scenario); });
}

TEST(ArmModel, ReadsTheMakersTableFromTheBodies) {
  const Scenario scenario = arm_among("model", "", "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}]}");
  const World world = World::load(scenario);
  const ArmModel arm = find_arm(world, scenario.robot.model);
  EXPECT_NEAR(arm.geometry.d1_m, 0.1625, 1e-12);
  EXPECT_NEAR(arm.geometry.a2_m, -0.425, 1e-12);
  EXPECT_NEAR(arm.geometry.a3_m, -0.3922, 1e-12);
  EXPECT_NEAR(arm.geometry.d4_m, 0.1333, 1e-12);
  EXPECT_NEAR(arm.geometry.d5_m, 0.0997, 1e-12);
  EXPECT_NEAR(arm.geometry.d6_m, 0.0996, 1e-12);
  EXPECT_NEAR(arm.limits.high[2], std::numbers::pi, 1e-12);
  EXPECT_EQ(arm.joints[0].stiffness, 3500);
  EXPECT_EQ(arm.joints[5].stiffness, 3000);
  // the camera looks along the flange's x axis, its rows along y
  EXPECT_LT((arm.T_flange_camera.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((arm.T_flange_camera.linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(ArmModel, TheBaseStandsWhereTheScenarioPutsIt) {
  Scenario scenario = arm_among("base", "", "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}]}");
  scenario.robot.start = {.x_m = 0.3, .y_m = -0.2, .yaw_deg = 90};
  const World world = World::load(scenario);
  const ArmModel arm = find_arm(world, scenario.robot.model);
  EXPECT_LT((arm.T_world_base.translation() - Eigen::Vector3d(0.3, -0.2, 0)).norm(), 1e-12);
  JointAngles q;
  q << 0.1, -1.0, 1.2, -0.4, 0.5, 0.6;
  const World::DataPtr state = world.make_data();
  arm.set_angles(q, *state);
  mj_kinematics(&world.model(), state.get());
  const slam::Pose expected = Eigen::Translation3d(0.3, -0.2, 0) *
                              Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                              forward_kinematics(arm.geometry, q);
  EXPECT_LT(slam::se3_log(arm.T_world_flange(*state).inverse() * expected).norm(), 1e-9);
  EXPECT_EQ(arm.angles(*state), q);
}

TEST(ArmModel, ARobotOnWheelsIsRefused) {
  Scenario scenario = arm_among("wheels", "", "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}]}");
  scenario.robot.model = std::filesystem::absolute("models/robots/p3dx.xml").string();
  const auto problems = problems_of([&] { plan_of(scenario); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].text(),
              HasSubstr("p3dx.xml: robot.model: a robot that moves about: wanted an arm, whose base stands"));
}

TEST(ArmPlan, PutsTheCameraWhereItIsPlanned) {
  const Scenario scenario =
      arm_among("there", "",
                "{speed_mps: 0.1, path: {z_m: 0.22, tilt_deg: -8, step_m: 0.03, step_deg: 10, drive: {x_m: "
                "0.3, y_m: -0.4, yaw_deg: 20, pieces: [{arc: {radius_m: 0.4, angle_deg: 120}}]}}}");
  const World world = World::load(scenario);
  const ArmModel arm = find_arm(world, scenario.robot.model);
  const ArmPlan plan = plan_arm(scenario, world, arm, kBaseline_m, kPeriod_ns);
  ASSERT_EQ(plan.q.size(), plan.stops.size());
  for (size_t i = 0; i < plan.stops.size(); ++i) {
    for (const Side side : {kLeft, kRight}) {
      const slam::Pose T_world_camera =
          arm.T_world_base * forward_kinematics(arm.geometry, plan.q[i][side]) * arm.T_flange_camera;
      const slam::Pose wanted =
          plan.stops[i].T_world_left * Eigen::Translation3d(side == kRight ? kBaseline_m : 0, 0, 0);
      EXPECT_LT(slam::se3_log(wanted.inverse() * T_world_camera).norm(), 1e-9);
    }
    if (i == 0) continue;  // one posture all the way: joints follow the path in small steps
    EXPECT_LT((plan.q[i][kLeft] - plan.q[i - 1][kRight]).cwiseAbs().maxCoeff(), 0.4) << i;
  }
}

TEST(ArmPlan, EveryPoseOutOfReachIsNamedWithByHowMuch) {
  const auto problems =
      problems_with("",
                    "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}, {x_m: 1.3, y_m: 0, z_m: "
                    "0.2}, {x_m: 0.02, y_m: 0.05, z_m: 0.6}, {x_m: 0.4, y_m: 0.1, z_m: 1.6}]}");
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_THAT(problems[0].text(), HasSubstr("plan.poses[1]: x 1.300 m, y 0.000 m, z 0.200 m: "));
  EXPECT_THAT(
      problems[0].text(),
      HasSubstr("mm beyond the arm's reach: wanted a place and a look direction that the arm can reach"));
  EXPECT_GT(problems[0].line, 0);
  EXPECT_THAT(problems[1].text(), HasSubstr("plan.poses[2]"));
  EXPECT_THAT(problems[2].text(), HasSubstr("plan.poses[3]"));
}

TEST(ArmPlan, OfAPathTheFirstStopOfEachRowOutOfReachIsNamed) {
  // out over the edge of the reach and back
  const auto problems = problems_with("",
                                      "{speed_mps: 0.1, path: {z_m: 0.2, step_m: 0.05, drive: {x_m: 0.5, "
                                      "y_m: 0, pieces: [{straight_m: 0.6}, {straight_m: "
                                      "-0.5}, {straight_m: 0.5}]}}}");
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_THAT(problems[0].text(), HasSubstr("plan.path (stop "));
  EXPECT_THAT(problems[0].text(), HasSubstr("beyond the arm's reach"));
}

TEST(ArmPlan, WhatIsTouchedIsNamed) {
  const auto problems = problems_with(
      "<geom name='post' type='cylinder' size='0.03 0.2' pos='0.45 0 0.2'/>",
      "{speed_mps: 0.1, poses: [{x_m: 0.45, y_m: 0.5, z_m: 0.2}, {x_m: 0.45, y_m: 0, z_m: 0.2}]}");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].text(), HasSubstr("plan.poses[1]: x 0.450 m, y 0.000 m, z 0.200 m: "));
  EXPECT_THAT(problems[0].text(),
              HasSubstr("touches post: wanted a pose at which the arm stays 0.005 m clear of everything"));
}

TEST(ArmPlan, ThingsOnTheWayBetweenTwoStopsAreFound) {
  // the hand swings through a thin post between two places that are both free
  const std::string post = "<geom name='post' type='cylinder' size='0.01 0.2' pos='0.62 0 0.2'/>";
  const std::string poses =
      "{speed_mps: 0.1, poses: [{x_m: 0.6, y_m: 0.25, z_m: 0.2}, {x_m: 0.6, y_m: -0.25, z_m: 0.2}]}";
  EXPECT_THAT(problems_with("", poses), IsEmpty());
  const auto problems = problems_with(post, poses);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].text(), HasSubstr("plan.poses[1]"));
  EXPECT_THAT(problems[0].text(), HasSubstr("on the way to it "));
  EXPECT_THAT(problems[0].text(),
              HasSubstr("touches post: wanted a way that stays 0.005 m clear of everything"));
}

TEST(ArmPlan, TheTableIsInTheWayToo) {
  const auto problems = problems_with("", "{speed_mps: 0.1, poses: [{x_m: 0.5, y_m: 0, z_m: 0.01}]}");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].text(), HasSubstr(" touches table"));
}

class ClearanceTest : public ::testing::Test {
 protected:
  /// What an arm among `geoms` touches.
  static std::optional<std::string> touch(const std::string& geoms, const JointAngles& q, double margin_m) {
    const Scenario scenario =
        arm_among("clearance", geoms, "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}]}");
    const World world = World::load(scenario);
    const ArmModel arm = find_arm(world, scenario.robot.model);
    return ArmClearance(world, arm).touch(q, margin_m);
  }
  static JointAngles upright() {
    JointAngles q = JointAngles::Zero();
    q[1] = q[3] = -std::numbers::pi / 2;
    return q;
  }
};

TEST_F(ClearanceTest, AnUprightArmTouchesNothing) { EXPECT_EQ(touch("", upright(), 0.005), std::nullopt); }

/// Of an upright arm the upper tube, 46 mm thick, stands 138 mm along -y beside the base's axis.
TEST_F(ClearanceTest, TheMarginIsMeasuredFromTheSurface) {
  const auto ball_at = [](double gap_m) {
    return "<geom name='ball' size='0.05' pos='" + std::to_string(0.046 + 0.05 + gap_m) + " -0.138 0.37'/>";
  };
  EXPECT_EQ(touch(ball_at(0.011), upright(), 0.01), std::nullopt);
  EXPECT_THAT(touch(ball_at(0.009), upright(), 0.01).value_or(""), HasSubstr("ur5e_upper_tube touches ball"));
  EXPECT_EQ(touch(ball_at(0.001), upright(), 0), std::nullopt);
  EXPECT_THAT(touch(ball_at(-0.001), upright(), 0).value_or(""), HasSubstr("ur5e_upper_tube touches ball"));
}

TEST_F(ClearanceTest, LinksMayNotTouchEachOther) {
  JointAngles folded = upright();
  folded[2] = 2.9;  // the forearm comes down beside the shoulder
  EXPECT_THAT(touch("", folded, 0.005).value_or(""), HasSubstr(" touches ur5e_"));
}

}  // namespace
}  // namespace groundloop::sim
