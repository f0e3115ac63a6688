#include "sim/robot/wheel_angles.h"

#include <gtest/gtest.h>

namespace groundloop::sim {
namespace {

Fault slip(double left, double right) {
  Fault fault;
  fault.at_s = 1;
  fault.for_s = 1;
  fault.wheel_slip = WheelSlipFault{left, right};
  return fault;
}

TEST(WheelFaults, SlipsMultiplyWhatIsLeftOfTheGrip) {
  const WheelFaults wheels = wheel_faults({}, {slip(0.5, 0), slip(0.2, -0.1)}, 1.5);
  EXPECT_NEAR(wheels.grip[0], 0.4, 1e-15);
  EXPECT_NEAR(wheels.grip[1], 1.1, 1e-15);
  EXPECT_EQ(wheel_faults({}, {slip(0.5, 0)}, 2).grip[0], 1) << "over";
}

TEST(WheelFaults, UnequalWheelsHaveTheStatedRatioAndTheSameMean) {
  const WheelFaults wheels = wheel_faults({1.05, 1}, {}, 0);
  EXPECT_NEAR(wheels.grip[1] / wheels.grip[0], 1.05, 1e-15);
  EXPECT_NEAR(wheels.grip[0] + wheels.grip[1], 2, 1e-15);
}

TEST(WheelAngles, WithoutFaultsAllAnglesAreTheSameToTheLastBit) {
  WheelAngles angles({0.1, 0.2});
  angles.update({0.3, 0.7}, {});
  EXPECT_EQ(angles.motor_rad(0), 0.3);
  EXPECT_EQ(angles.counted_rad(1), 0.7);
}

TEST(WheelAngles, ASlippingMotorTurnsFartherThanItsWheelRolls) {
  WheelAngles angles({0, 0});
  angles.update({0.7, 1}, wheel_faults({}, {slip(0.3, 0)}, 1));
  EXPECT_NEAR(angles.motor_rad(0), 1, 1e-15) << "70 % of what it turned";
  EXPECT_EQ(angles.motor_rad(1), 1);
  angles.update({1.7, 2}, {});
  EXPECT_NEAR(angles.motor_rad(0), 2, 1e-15) << "with grip again it rolls as it turns";
  EXPECT_NEAR(angles.counted_rad(0), 2, 1e-15) << "the encoder sits on the motor";
}

TEST(WheelAngles, AFailingEncoderCountsAPartOfWhatTheMotorTurns) {
  Fault fault;
  fault.encoder = EncoderFault{0.25, 0};
  WheelAngles angles({0, 0});
  angles.update({1, 1}, wheel_faults({}, {fault}, 0));
  EXPECT_EQ(angles.motor_rad(0), 1);
  EXPECT_EQ(angles.counted_rad(0), 0.25);
  EXPECT_EQ(angles.counted_rad(1), 0);
  angles.update({2, 2}, {});
  EXPECT_EQ(angles.counted_rad(0), 1.25) << "what was missed stays missed";
}

}  // namespace
}  // namespace groundloop::sim
