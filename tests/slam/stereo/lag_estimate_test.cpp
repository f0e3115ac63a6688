#include "slam/stereo/lag_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/stereo/right_lag.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

constexpr double kNoise_px = 0.1;
constexpr int kMatches = 300;

Vector6d velocity(double ahead_mps, double turning_radps) {
  Vector6d velocity = Vector6d::Zero();
  velocity(2) = ahead_mps;
  velocity(4) = turning_radps;
  return velocity;
}

/// By what a calibration puts rows wrong: all alike, and by direction in the image.
struct RowError {
  double offset_px = 0;
  double by_x_px = 0;
  double by_y_px = 0;
  double aside_px = 0;  ///< turned so that the image's middle has moved by that
  double up_px = 0;     ///< the same, after its middle row was put right
};

class LagEstimateTest : public testing::Test {
 protected:
  /// Matches of a pair whose right image is late, at points 1 to 5 m away; every n-th one is false.
  std::vector<LagSight> sights(const Vector6d& moves, double late_s, int false_every = 1000) {
    ++pair_;
    const RightLag known(moves, estimate_.late_s()), true_lag(moves, late_s);
    std::vector<LagSight> sights;
    for (int i = 0; i < kMatches; ++i) {
      const auto draw = [&](uint64_t what) { return uniform(pair_, static_cast<uint64_t>(i), what); };
      const Eigen::Vector2d at(1.1 * draw(0) - 0.55, 0.8 * draw(1) - 0.4);
      const double z_m = 1 + 4 * draw(2);
      const Eigen::Vector3d p_left(at.x() * z_m, at.y() * z_m, z_m);
      double off_px = true_lag.shift_px(rig_, p_left).y() - known.shift_px(rig_, p_left).y();
      off_px += rows_.offset_px + rows_.by_x_px * at.x() + rows_.by_y_px * at.y() +
                rows_.aside_px * at.x() * at.y() + rows_.up_px * at.y() * at.y();
      off_px += kNoise_px * std::sqrt(12.0) * (draw(3) - 0.5);
      if (i % false_every == 0) off_px = 10 * draw(4) - 5;
      sights.push_back({at, off_px, known.row_flow_px_per_s(rig_, p_left)});
    }
    return sights;
  }
  double observe(const Vector6d& moves, double late_s) {
    estimate_.observe(sights(moves, late_s));
    return estimate_.late_s();
  }

  const Vector6d ahead_ = velocity(0.3, 0), turning_ = velocity(0.1, 0.5), at_rest_ = Vector6d::Zero();
  const StereoRig rig_ = centred_rig(640, 480, 577, 0.088);
  RowError rows_;
  LagEstimate estimate_{StereoOptions{}};  // up to 0.1 s
  uint64_t pair_ = 0;
};

TEST_F(LagEstimateTest, ALongDelayIsFoundInItsFirstPairAndEndsWithIt) {
  for (const Vector6d& moves : {ahead_, turning_}) {
    for (const double late_s : {0.05, -0.03}) {
      for (int i = 0; i < 5; ++i) EXPECT_EQ(observe(moves, 0), 0);
      for (int i = 0; i < 10; ++i) EXPECT_NEAR(observe(moves, late_s), late_s, 0.004) << i;
      for (int i = 0; i < 5; ++i) EXPECT_EQ(observe(moves, 0), 0) << i;
    }
  }
}

TEST_F(LagEstimateTest, AShortDelayIsFoundAndOneThatDoesNoHarmIsNot) {
  for (int i = 0; i < 10; ++i) observe(turning_, 0.006);
  EXPECT_NEAR(estimate_.late_s(), 0.006, 0.001);
  estimate_ = LagEstimate(StereoOptions{});
  for (int i = 0; i < 50; ++i) EXPECT_EQ(observe(turning_, 0.001), 0) << i;
}

TEST_F(LagEstimateTest, RightPairsHaveNone) {
  for (int i = 0; i < 300; ++i) EXPECT_EQ(observe(i % 3 == 0 ? ahead_ : turning_, 0), 0) << i;
}

TEST_F(LagEstimateTest, WhatACalibrationIsOffByIsNoDelay) {
  for (const RowError& rows : {RowError{0.3}, RowError{0, 0.4}, RowError{0, 0, 0.4}}) {
    rows_ = rows;
    for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(i % 2 == 0 ? ahead_ : turning_, 0), 0) << i;
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(observe(turning_, 0.03), 0.03, 0.003) << i;
    EXPECT_EQ(observe(turning_, 0), 0);
  }
}

TEST_F(LagEstimateTest, AKnockIsNoDelayWhicheverWayTheHeadThenMoves) {
  for (const Vector6d& moves : {ahead_, turning_, at_rest_}) {
    estimate_ = LagEstimate(StereoOptions{});
    rows_ = {};
    for (int i = 0; i < 10; ++i) EXPECT_EQ(observe(moves, 0), 0) << i;
    rows_ = {.aside_px = 1, .up_px = 1};
    for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(moves, 0), 0) << i;
    for (const double radps : {0.05, 0.2, 0.5, 0.3, 0.1}) {
      for (int i = 0; i < 10; ++i) EXPECT_EQ(observe(velocity(0.5 * radps, radps), 0), 0) << radps;
      for (int i = 0; i < 10; ++i) EXPECT_EQ(observe(velocity(0, radps), 0), 0) << radps;
    }
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(observe(turning_, 0.03), 0.03, 0.003) << i;
    EXPECT_EQ(observe(turning_, 0), 0);
  }
}

TEST_F(LagEstimateTest, ADelayIsFoundWhereTheHeadTurnsOnTheSpot) {
  const Vector6d on_the_spot = velocity(0, 0.5);
  for (int i = 0; i < 5; ++i) observe(ahead_, 0);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(observe(on_the_spot, 0.01), 0.01, 0.001) << i;
  EXPECT_EQ(observe(on_the_spot, 0), 0);
}

TEST_F(LagEstimateTest, WithTooLittleFlowNothingIsLearntAndNothingForgotten) {
  const Vector6d creeping = velocity(0.002, 0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(creeping, 0.05), 0);
  const double late_s = observe(turning_, 0.05);
  EXPECT_NEAR(late_s, 0.05, 0.002);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(creeping, 0.05), late_s);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(at_rest_, 0), late_s);
}

TEST_F(LagEstimateTest, FalseMatchesDoNotMakeOne) {
  for (int i = 0; i < 20; ++i) {
    estimate_.observe(sights(turning_, 0, 4));
    EXPECT_EQ(estimate_.late_s(), 0) << i;
  }
  estimate_.observe(sights(turning_, 0.03, 4));
  EXPECT_NEAR(estimate_.late_s(), 0.03, 0.003);
}

TEST_F(LagEstimateTest, FewMatchesAndMatchesAtOddsTellNothing) {
  std::vector<LagSight> few = sights(turning_, 0.05);
  few.resize(20);
  estimate_.observe(few);
  estimate_.observe(sights(turning_, 0.05, 1));
  EXPECT_EQ(estimate_.late_s(), 0);
}

TEST_F(LagEstimateTest, TooLongADelayIsLeft) {
  estimate_ = LagEstimate({.max_right_late_s = 0.04});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(observe(turning_, 0.05), 0);
  EXPECT_NEAR(observe(turning_, 0.03), 0.03, 0.003);
  estimate_ = LagEstimate({.max_right_late_s = 0});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(observe(turning_, 0.03), 0);
}

}  // namespace
}  // namespace groundloop::slam
