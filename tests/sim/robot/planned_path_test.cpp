#include "sim/robot/planned_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kPi = std::numbers::pi;
const DriveLimits kLimits{
    .wheel_radius_m = 0.1, .track_m = 0.4, .wheel_speed_radps = 10, .wheel_acceleration_radps2 = 4};

Segment straight(double length_m) {
  Segment segment;
  segment.straight_m = length_m;
  return segment;
}
Segment arc(double radius_m, double angle_deg) {
  Segment segment;
  segment.arc = ArcSegment{radius_m, angle_deg};
  return segment;
}
Segment stop(double time_s) {
  Segment segment;
  segment.stop_s = time_s;
  return segment;
}
PlannedPath path_of(std::vector<Segment> segments, double speed_mps = 0.2, double turn_rate_degps = 300,
                    StartPose start = {}) {
  Plan plan;
  plan.speed_mps = speed_mps;
  plan.turn_rate_limit_degps = turn_rate_degps;
  plan.segments = std::move(segments);
  return {start, plan, kLimits};
}

TEST(SpeedRamp, TrapezoidInClosedForm) {
  const SpeedRamp ramp(0.25, 0.5);  // 0.5 s up over 1/16, 3.5 s cruise, 0.5 s down
  EXPECT_DOUBLE_EQ(ramp.duration_s(), 4.5);
  EXPECT_DOUBLE_EQ(ramp.progress(0.5), 0.0625);
  EXPECT_DOUBLE_EQ(ramp.rate(0.25), 0.125);
  EXPECT_DOUBLE_EQ(ramp.progress(2.25), 0.5);
  EXPECT_DOUBLE_EQ(ramp.rate(2.25), 0.25);
  EXPECT_DOUBLE_EQ(ramp.progress(4), 0.9375);
  EXPECT_DOUBLE_EQ(ramp.progress(4.5), 1);
  EXPECT_DOUBLE_EQ(ramp.progress(-1), 0);
  EXPECT_DOUBLE_EQ(ramp.rate(9), 0);
}

TEST(SpeedRamp, TooShortToCruiseIsATriangle) {
  const SpeedRamp ramp(10, 4);
  EXPECT_DOUBLE_EQ(ramp.duration_s(), 1);
  EXPECT_DOUBLE_EQ(ramp.rate(0.5), 2);
  EXPECT_DOUBLE_EQ(ramp.progress(0.5), 0.5);
}

TEST(PlannedPath, EndsWhereGeometrySays) {
  // a stadium of straights of 2 m and half circles of radius 1 comes back to its start
  const PlannedPath path = path_of({straight(2), arc(1, 180), straight(2), arc(1, 180)}, 0.2, 300,
                                   {.x_m = 3, .y_m = -1, .yaw_deg = 90});
  EXPECT_NEAR(path.length_m(), 4 + 2 * kPi, 1e-12);
  const Pose2 half = path.at_fraction(1, 1);
  EXPECT_NEAR(half.x_m, 1, 1e-12);  // to the left of +y is -x
  EXPECT_NEAR(half.y_m, 1, 1e-12);
  EXPECT_NEAR(half.yaw_rad, 1.5 * kPi, 1e-12);
  const Pose2 end = path.at(path.duration_s()).T_world_body;
  EXPECT_NEAR(end.x_m, 3, 1e-12);
  EXPECT_NEAR(end.y_m, -1, 1e-12);
  EXPECT_NEAR(end.yaw_rad, 2.5 * kPi, 1e-12);
}

TEST(PlannedPath, TimesFollowFromTheLimits) {
  // a = 4 rad/s^2 * 0.1 m = 0.4 m/s^2: 0.5 s to 0.2 m/s, twice, and 1.9 m at full speed
  EXPECT_NEAR(path_of({straight(2)}).duration_s(), 0.5 + 9.5 + 0.5, 1e-12);
  EXPECT_NEAR(path_of({straight(-2)}).duration_s(), 10.5, 1e-12);
  EXPECT_NEAR(path_of({straight(2), stop(3)}).duration_s(), 13.5, 1e-12);
  // the outer wheel limits an arc of radius 0.6 to 0.4 * 0.6 / 0.8 = 0.3 m/s^2
  EXPECT_NEAR(path_of({arc(0.6, 180)}, 0.3).duration_s(), 0.6 * kPi / 0.3 + 1.0, 1e-12);
  // a turn on the spot: 30 deg/s, and 4 * 0.1 / 0.2 = 2 rad/s^2
  EXPECT_NEAR(path_of({arc(0, 90)}, 0.2, 30).duration_s(), 3 + kPi / 12, 1e-12);
  // the turn rate slows the arc: 30 deg/s on a radius of 0.3 m is 0.157 m/s
  EXPECT_NEAR(path_of({arc(0.3, 360)}, 0.2, 30).at(6).twist.speed_mps, 0.3 * kPi / 6, 1e-12);
  // the wheels: 10 rad/s * 0.1 m
  EXPECT_NEAR(path_of({straight(20)}, 1.2).at(11).twist.speed_mps, 1.0, 1e-12);
}

TEST(PlannedPath, PoseAndSpeedAreContinuousAndKeepToTheLimits) {
  const PlannedPath path = path_of(
      {straight(1), arc(0.5, 90), stop(0.5), arc(0, -120), straight(-0.4), arc(2, -30), straight(0.01)}, 0.25,
      60);
  const double h = 1e-3;
  PlannedState before = path.at(0);
  double driven_m = 0;
  for (double t = h; t < path.duration_s() + 1; t += h) {
    const PlannedState now = path.at(t);
    const double moved_m = std::hypot(now.T_world_body.x_m - before.T_world_body.x_m,
                                      now.T_world_body.y_m - before.T_world_body.y_m);
    driven_m += moved_m;
    const double mean_mps = (std::abs(now.twist.speed_mps) + std::abs(before.twist.speed_mps)) / 2;
    const double mean_radps = (now.twist.turn_rate_radps + before.twist.turn_rate_radps) / 2;
    ASSERT_NEAR(moved_m, mean_mps * h, 2e-7) << "at " << t;
    ASSERT_NEAR(now.T_world_body.yaw_rad - before.T_world_body.yaw_rad, mean_radps * h, 1e-6) << "at " << t;
    for (const double side : {-0.2, 0.2}) {
      const double wheel_radps = (now.twist.speed_mps + side * now.twist.turn_rate_radps) / 0.1;
      const double wheel_before_radps = (before.twist.speed_mps + side * before.twist.turn_rate_radps) / 0.1;
      ASSERT_LE(std::abs(wheel_radps), 10 + 1e-9);
      ASSERT_LE(std::abs(wheel_radps - wheel_before_radps), 4 * h * (1 + 1e-6)) << "at " << t;
    }
    before = now;
  }
  EXPECT_NEAR(driven_m, path.length_m(), 1e-5);
}

TEST(PlannedPath, StandsBeforeAndAfter) {
  const PlannedPath path = path_of({straight(1)});
  EXPECT_EQ(path.at(-5).T_world_body.x_m, 0);
  EXPECT_EQ(path.at(1000).T_world_body.x_m, 1);
  EXPECT_EQ(path.at(1000).twist.speed_mps, 0);
}

TEST(PlannedPath, SegmentsWithoutMotionTakeNoTime) {
  const PlannedPath path = path_of({straight(0), arc(1, 0), stop(0), straight(1)});
  EXPECT_NEAR(path.duration_s(), 5.5, 1e-12);
  EXPECT_EQ(path.at(1).segment, 3U);
  EXPECT_NEAR(path.at(path.duration_s()).T_world_body.x_m, 1, 1e-12);
}

TEST(PlannedPath, TheHeadTurnsWhileTheRobotStandsAndStaysTurned) {
  Segment left, right;
  left.look = LookSegment{90, 0};
  right.look = LookSegment{-30, 30};
  Plan plan;
  plan.speed_mps = 0.2;
  plan.look_speed_degps = 20;
  plan.segments = {left, straight(1), right, right, stop(1)};
  const PlannedPath path({}, plan, kLimits, 2);
  const double speed_radps = 20 * kPi / 180;
  const double first_s = 90 / 20.0 + speed_radps / 2;  // ramps of 2 rad/s^2
  EXPECT_NEAR(path.at(first_s / 2).head.pan_rad, kPi / 4, 1e-12);
  EXPECT_NEAR(path.at(first_s / 2).head_rate.pan_rad, speed_radps, 1e-12);
  EXPECT_EQ(path.at(first_s / 2).twist.speed_mps, 0);
  EXPECT_EQ(path.at(first_s / 2).T_world_body.x_m, 0);
  const double driving_s = first_s + 1;
  EXPECT_NEAR(path.at(driving_s).head.pan_rad, kPi / 2, 1e-12);
  EXPECT_EQ(path.at(driving_s).head_rate.pan_rad, 0);
  EXPECT_GT(path.at(driving_s).twist.speed_mps, 0.1);
  const PlannedState end = path.at(path.duration_s());
  EXPECT_NEAR(end.head.pan_rad, -kPi / 6, 1e-12);
  EXPECT_NEAR(end.head.tilt_rad, kPi / 6, 1e-12);
  EXPECT_NEAR(end.T_world_body.x_m, 1, 1e-12);
  // looking where it looks already takes no time
  const double straight_s = 1 / 0.2 + 0.2 / 0.1 / 4;
  EXPECT_NEAR(path.duration_s(), first_s + straight_s + 120 / 20.0 + speed_radps / 2 + 1, 1e-9);
}

}  // namespace
}  // namespace groundloop::sim
