#include "sim/robot/controller.h"

#include <gtest/gtest.h>

#include <cmath>

namespace groundloop::sim {
namespace {

const DriveLimits kLimits{
    .wheel_radius_m = 0.1, .track_m = 0.4, .wheel_speed_radps = 10, .wheel_acceleration_radps2 = 4};

/// Distance from the reference after following it for a while from a wrong place.
double error_after_m(double way_m, const BodyTwist& reference, Pose2 actual) {
  PlannedState planned{{}, reference, 0};
  const double h = 0.002;
  for (double t = 0; t * std::abs(reference.speed_mps) < way_m; t += h) {
    const BodyTwist twist = tracking_twist(planned, actual);
    actual = driven(actual, twist.speed_mps * h, twist.turn_rate_radps * h);
    planned.T_world_body =
        driven(planned.T_world_body, reference.speed_mps * h, reference.turn_rate_radps * h);
  }
  return std::hypot(actual.x_m - planned.T_world_body.x_m, actual.y_m - planned.T_world_body.y_m) +
         std::abs(wrapped(actual.yaw_rad - planned.T_world_body.yaw_rad));
}

TEST(TrackingTwist, OnTheReferenceItIsTheReference) {
  const PlannedState planned{{1, 2, 0.5}, {0.2, -0.3}, 0};
  const BodyTwist twist = tracking_twist(planned, planned.T_world_body);
  EXPECT_DOUBLE_EQ(twist.speed_mps, 0.2);
  EXPECT_DOUBLE_EQ(twist.turn_rate_radps, -0.3);
}

TEST(TrackingTwist, ComesBackWithinTwoMetresAtAnySpeed) {
  for (const double speed_mps : {0.05, 0.2, 1.0, -0.2}) {
    for (const double curvature_per_m : {0.0, 0.5, -1.0}) {
      const BodyTwist reference{speed_mps, std::abs(speed_mps) * curvature_per_m};
      EXPECT_LT(error_after_m(2.5, reference, {-0.05, 0.08, 0.2}), 0.005)
          << speed_mps << " " << curvature_per_m;
    }
  }
}

TEST(TrackingTwist, SteersTowardsTheReference) {
  const PlannedState planned{{0, 0, 0}, {0.2, 0}, 0};
  EXPECT_LT(tracking_twist(planned, {0, 0.1, 0}).turn_rate_radps, 0) << "left of the line: to the right";
  EXPECT_GT(tracking_twist(planned, {0, 0, -0.1}).turn_rate_radps, 0);
  EXPECT_GT(tracking_twist(planned, {-0.1, 0, 0}).speed_mps, 0.2) << "behind: faster";
}

TEST(WheelController, KeepsToAccelerationAndSpeed) {
  WheelController wheels(kLimits, 0, 0);
  double left_rad = 0, right_rad = 0, before_radps = 0;
  const double h = 0.002;
  for (int i = 0; i < 5000; ++i) {
    const WheelSpeeds speeds = wheels.command({5, 0}, left_rad, right_rad, h);  // 50 rad/s wanted
    ASSERT_LE(speeds.left_radps - before_radps, 4 * h + 1e-9);
    before_radps = speeds.left_radps;
    left_rad += speeds.left_radps * h;
    right_rad += speeds.right_radps * h;
  }
  EXPECT_DOUBLE_EQ(before_radps, 10);
}

TEST(WheelController, TurnsTwistsIntoWheels) {
  WheelController wheels(kLimits, 0, 0);
  const WheelSpeeds speeds = wheels.command({0.2, 0.5}, 0, 0, 10);
  EXPECT_NEAR(speeds.left_radps, 1, 1e-12);
  EXPECT_NEAR(speeds.right_radps, 3, 1e-12);
}

TEST(WheelController, MakesUpForALaggingWheel) {
  WheelController wheels(kLimits, 0, 0);
  const double h = 0.002;
  double left_rad = 0, right_rad = 0, wanted_rad = 0;
  for (int i = 0; i < 2000; ++i) {
    const WheelSpeeds speeds = wheels.command({0.2, 0}, left_rad, right_rad, h);
    left_rad += 0.9 * speeds.left_radps * h;  // a weak servo
    right_rad += speeds.right_radps * h;
    wanted_rad += std::min(2.0, 4 * h * (i + 1)) * h;
  }
  EXPECT_NEAR(right_rad, wanted_rad, 1e-9);
  EXPECT_NEAR(left_rad, wanted_rad, 0.02) << "without correction it would be 0.75 rad behind";
}

}  // namespace
}  // namespace groundloop::sim
