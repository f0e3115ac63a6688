#include "sim/robot/pose2.h"

#include <gtest/gtest.h>

#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_pose(const Pose2& actual, double x_m, double y_m, double yaw_rad, double tolerance = 1e-12) {
  EXPECT_NEAR(actual.x_m, x_m, tolerance);
  EXPECT_NEAR(actual.y_m, y_m, tolerance);
  EXPECT_NEAR(actual.yaw_rad, yaw_rad, tolerance);
}

TEST(Pose2, DrivingIsExact) {
  expect_pose(driven({1, 2, 0}, 3, 0), 4, 2, 0);
  expect_pose(driven({0, 0, kPi / 2}, -3, 0), 0, -3, kPi / 2);
  expect_pose(driven({0, 0, 0}, kPi, kPi), 0, 2, kPi);                    // half a circle of radius 1
  expect_pose(driven({0, 0, 0}, kPi, -kPi / 2), 2, -2, -kPi / 2);         // quarter of radius 2, to the right
  expect_pose(driven({5, 6, 0}, 0, 1), 5, 6, 1);                          // on the spot
  expect_pose(driven({0, 0, 0}, 8 * kPi, 4 * kPi), 0, 0, 4 * kPi, 1e-9);  // two whole turns
  // a nearly straight arc is a straight to second order
  expect_pose(driven({0, 0, 0}, 1, 1e-9), 1, 0.5e-9, 1e-9);
}

TEST(Pose2, TheInverseLeadsBack) {
  const Pose2 T_a_b = {3, -2, 0.7};
  expect_pose(composed(T_a_b, inverse(T_a_b)), 0, 0, 0);
  expect_pose(composed(inverse(T_a_b), T_a_b), 0, 0, 0);
}

TEST(Pose2, PiecesAddUp) {
  Pose2 pose;
  for (int i = 0; i < 1000; ++i) pose = driven(pose, 0.002, 0.003);
  const Pose2 at_once = driven({}, 2, 3);
  expect_pose(pose, at_once.x_m, at_once.y_m, at_once.yaw_rad, 1e-11);
}

TEST(Pose2, ComposesLikePosesInSpace) {
  const Pose2 a{1, 2, 0.5}, b{-0.3, 0.7, 2.9};
  expect_pose(composed(a, b), to_pose2(to_pose(a) * to_pose(b)).x_m, to_pose2(to_pose(a) * to_pose(b)).y_m,
              3.4);
  EXPECT_TRUE(to_pose(composed(a, b)).isApprox(to_pose(a) * to_pose(b), 1e-12));
}

TEST(Pose2, WrapsToHalfTurns) {
  EXPECT_NEAR(wrapped(3 * kPi / 2), -kPi / 2, 1e-12);
  EXPECT_NEAR(wrapped(-5 * kPi + 0.1), -kPi + 0.1, 1e-12);
  EXPECT_EQ(wrapped(0.5), 0.5);
}

}  // namespace
}  // namespace groundloop::sim
