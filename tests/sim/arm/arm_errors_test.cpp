#include "sim/arm/arm_errors.h"

#include <gtest/gtest.h>

#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(ArmErrors, HandEyeIsInTheCamerasAxes) {
  const slam::Pose T = hand_eye_error({.x_m = 0.001, .y_m = 0.002, .z_m = 0.003});
  EXPECT_TRUE(T.isApprox(slam::Pose(Eigen::Translation3d(0.001, 0.002, 0.003)), 1e-15));
  // panned to the left, the optical axis points to negative x; tilted up, to negative y; rolled, x goes down
  EXPECT_NEAR(hand_eye_error({.pan_deg = 2}).linear()(0, 2), -std::sin(2 * kDegree), 1e-12);
  EXPECT_NEAR(hand_eye_error({.tilt_deg = 2}).linear()(1, 2), -std::sin(2 * kDegree), 1e-12);
  EXPECT_NEAR(hand_eye_error({.roll_deg = 2}).linear()(1, 0), std::sin(2 * kDegree), 1e-12);
}

TEST(ArmErrors, NoErrorIsNone) {
  EXPECT_TRUE(repeatability_error({}, 7, 3).isApprox(slam::Pose::Identity(), 0));
  EXPECT_TRUE(hand_eye_error({}).isApprox(slam::Pose::Identity(), 0));
}

TEST(ArmErrors, RepeatabilityHasItsStandardDeviationsAndNoMean) {
  const ArmErrors errors{.repeatability_m = 1e-4, .repeatability_deg = 0.02, .hand_eye = {}};
  constexpr int kStops = 4000;
  slam::Vector6d sum = slam::Vector6d::Zero();
  slam::Matrix6d squares = slam::Matrix6d::Zero();
  for (int stop = 0; stop < kStops; ++stop) {
    slam::Vector6d twist = slam::se3_log(repeatability_error(errors, 5, stop));
    twist.head<3>() /= 1e-4;
    twist.tail<3>() /= 0.02 * kDegree;
    sum += twist;
    squares += twist * twist.transpose();
  }
  // of so many, a mean errs by 0.016, a variance by 0.022, a covariance by 0.016; four of those
  EXPECT_LT((sum / kStops).cwiseAbs().maxCoeff(), 0.064);
  EXPECT_LT((squares / kStops - slam::Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.09);
}

TEST(ArmErrors, EveryStopHasItsOwnAndSeedsDiffer) {
  const ArmErrors errors{.repeatability_m = 1e-4, .repeatability_deg = 0, .hand_eye = {}};
  const auto p = [&](uint64_t seed, int64_t stop) {
    return repeatability_error(errors, seed, stop).translation().eval();
  };
  EXPECT_EQ(p(1, 4), p(1, 4));
  EXPECT_NE(p(1, 4), p(1, 5));
  EXPECT_NE(p(1, 4), p(2, 4));
}

}  // namespace
}  // namespace groundloop::sim
