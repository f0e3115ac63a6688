#include "sim/arm/arm_servo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/arm/test_arm.h"

namespace groundloop::sim {
namespace {

class ServoTest : public ::testing::Test {
 protected:
  explicit ServoTest(double stiffness_factor = 1)
      : scenario(arm_among("servo", "", "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}]}")),
        world(World::load(scenario)),
        arm(find_arm(world, scenario.robot.model)) {
    for (auto& joint : arm.joints) joint.stiffness *= stiffness_factor;
    start << 0.2, -1.2, 1.5, -0.6, 1.4, 0.3;
  }
  Scenario scenario;
  World world;
  ArmModel arm;
  JointAngles start;
};

TEST_F(ServoTest, StandsWhereItIsSentWithoutSaggingUnderItsWeight) {
  ArmServo servo(world, arm, start);
  for (const double lift : {-0.9, -0.2, -1.6}) {
    JointAngles q = start;
    q[1] = lift;
    q[4] += 0.05;
    ASSERT_TRUE(servo.move_to(q, 0));
    EXPECT_LT((arm.angles(servo.state()) - q).cwiseAbs().maxCoeff(), kSettled_rad);
    for (const auto& joint : arm.joints) EXPECT_LT(std::abs(servo.state().qvel[joint.dof]), kStill_radps);
  }
}

TEST_F(ServoTest, KeepsToItsSpeedAndToTheTimeAskedFor) {
  JointAngles q = start;
  q[0] += 1;
  ArmServo fast(world, arm, start);
  ASSERT_TRUE(fast.move_to(q, 0));
  const double least_s =
      std::max(1.875 / arm.joint_speed_radps, std::sqrt(5.7735 / arm.joint_acceleration_radps2));
  EXPECT_GE(fast.time_s(), least_s);
  EXPECT_LT(fast.time_s(), least_s + 0.5);
  ArmServo slow(world, arm, start);
  ASSERT_TRUE(slow.move_to(q, 2));
  EXPECT_GE(slow.time_s(), 1.875 * 2);
}

TEST_F(ServoTest, ASmallStepTakesWellUnderASecond) {
  ArmServo servo(world, arm, start);
  ASSERT_TRUE(servo.move_to(start + JointAngles::Constant(0.02), 0));
  EXPECT_LT(servo.time_s(), 0.6);
}

TEST_F(ServoTest, IsTheSameEveryTime) {
  const auto end = [&] {
    ArmServo servo(world, arm, start);
    servo.move_to(start + JointAngles::Constant(0.1), 0);
    return std::pair(arm.angles(servo.state()), servo.time_s());
  };
  EXPECT_EQ(end(), end());
}

/// A controller that takes its servos for four times as stiff does not make up for the weight.
class WeakServoTest : public ServoTest {
 protected:
  WeakServoTest() : ServoTest(4) {}
};

TEST_F(WeakServoTest, AnArmThatDoesNotComeToRestIsGivenUp) {
  ArmServo servo(world, arm, start);
  JointAngles q = start;
  q[1] = -0.3;
  EXPECT_FALSE(servo.move_to(q, 0));
  EXPECT_THAT(servo.unrest(q),
              ::testing::MatchesRegex("joint [23] is 0\\.[0-9]+ deg off and turns at .* deg/s"));
}

}  // namespace
}  // namespace groundloop::sim
