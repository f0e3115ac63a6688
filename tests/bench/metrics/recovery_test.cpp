#include "bench/metrics/recovery.h"

#include <gtest/gtest.h>

#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using slam::FrameResult;
using slam::Pose;
using slam::TrackingStatus;

/// Drives 0.1 m a frame, ten frames a second, along x, with a key frame at every fifth; world and map differ
/// by a turn. What is given to drive() is the error of the estimate.
class Recovery : public testing::Test {
 protected:
  void drive(TrackingStatus status = TrackingStatus::kTracking,
             const Pose& T_true_estimate = moved(0, 0, 0)) {
    step(moved(0.1, 0, 0), status, T_true_estimate);
  }
  /// A true step that may be another than the planned one.
  void step(const Pose& T_true_step, TrackingStatus status, const Pose& T_true_estimate, int segment = 0,
            bool with_link = false) {
    T_world_left_ = T_world_left_ * T_true_step;
    FrameResult result;
    result.index = frame_;
    result.stamp_ns = 100'000'000 * frame_;
    result.status = status;
    result.segment = segment;
    result.T_map_left = T_world_map_.inverse() * T_world_left_ * T_true_estimate;
    if (with_link) result.links.emplace_back();
    if (frame_ % 5 == 0) map_.push_back({frame_, result.T_map_left, T_world_left_});
    judge_.observe({result, moved(0.1, 0, 0), T_world_left_}, [this] { return map_; });
    ++frame_;
  }
  void drive_on(int frames) {
    for (int i = 0; i < frames; ++i) drive();
  }

  const Pose T_world_map_ = turned(40, {0, 0, 1}) * moved(1, 2, 0);
  Pose T_world_left_ = Pose::Identity();
  int64_t frame_ = 0;
  std::vector<MappedView> map_;
  RecoveryJudge judge_;
};

TEST_F(Recovery, AnUndisturbedRunHasNothingToTell) {
  EXPECT_TRUE(judge_.metrics().empty());
  drive_on(30);
  EXPECT_EQ(judge_.metrics(), (Metrics{{"tracking.interruptions", 0}, {"tracking.silent_jumps", 0}}));
}

TEST_F(Recovery, LossLastsUntilThePoseIsRightAgain) {
  drive_on(20);
  for (int i = 0; i < 3; ++i) drive(TrackingStatus::kLost);
  // it says that it tracks, but it is wrong: 0.12 m, then 2.5 deg, then 0.08 m
  drive(TrackingStatus::kStarted, moved(0, 0.12, 0));
  drive(TrackingStatus::kTracking, moved(0, 0.12, 0));
  drive(TrackingStatus::kTracking, turned(2.5, {0, 0, 1}));
  EXPECT_FALSE(judge_.metrics().contains("tracking.relocalised_s")) << "it has not ended";
  drive(TrackingStatus::kTracking, moved(0, 0.08, 0));
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.6, 1e-9);
  EXPECT_EQ(judge_.metrics().at("tracking.interruptions"), 1);
  // of several the longest counts
  drive_on(5);
  drive(TrackingStatus::kLost);
  drive_on(5);
  EXPECT_EQ(judge_.metrics().at("tracking.interruptions"), 2);
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.6, 1e-9);
}

TEST_F(Recovery, LostFramesWithAGoodGuessAreStillLost) {
  drive_on(20);
  for (int i = 0; i < 4; ++i) drive(TrackingStatus::kLost);
  drive();
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.4, 1e-9);
}

TEST_F(Recovery, BeingCarriedAwayIsToldByTheTruth) {
  drive_on(40);
  // 2 m back, into the mapped part; the estimate does not notice and goes on for five frames
  const Pose T_back = moved(-2, 0, 0);
  step(T_back, TrackingStatus::kTracking, moved(2.1, 0, 0));
  for (int i = 0; i < 5; ++i) drive(TrackingStatus::kTracking, moved(2.1, 0, 0));
  EXPECT_FALSE(judge_.metrics().contains("tracking.relocalised_s"));
  step(moved(0.1, 0, 0), TrackingStatus::kTracking, Pose::Identity(), 1, true);
  EXPECT_EQ(judge_.metrics().at("tracking.interruptions"), 1);
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.6, 1e-9);
  EXPECT_EQ(judge_.metrics().at("tracking.silent_jumps"), 0);
}

TEST_F(Recovery, BeingPutAsideAndFollowedAtOnceTakesNoTime) {
  drive_on(40);
  step(moved(0.1, 0.09, 0), TrackingStatus::kTracking, Pose::Identity());
  EXPECT_EQ(judge_.metrics().at("tracking.interruptions"), 0) << "wheels may slip";
  step(moved(-0.3, 0.2, 0) * turned(-15, {0, 0, 1}), TrackingStatus::kTracking, Pose::Identity());
  EXPECT_EQ(judge_.metrics().at("tracking.interruptions"), 1);
  EXPECT_EQ(judge_.metrics().at("tracking.relocalised_s"), 0);
  EXPECT_EQ(judge_.metrics().at("tracking.silent_jumps"), 0);
}

TEST_F(Recovery, KeyFramesMadeSinceDoNotMakeItRight) {
  drive_on(40);
  step(moved(-2, 0, 0), TrackingStatus::kTracking, moved(2.1, 0, 0));
  for (int i = 0; i < 30; ++i)
    drive(TrackingStatus::kTracking, moved(2.1, 0, 0));  // agrees with itself alone
  EXPECT_FALSE(judge_.metrics().contains("tracking.relocalised_s"));
}

TEST_F(Recovery, DriftOfTheWholeMapIsNotHeldAgainstIt) {
  // the estimate is 3 % too short: after 4 m it is off by 0.12 m, and so is its map
  for (int i = 0; i < 40; ++i) drive(TrackingStatus::kTracking, moved(-0.003 * i, 0, 0));
  drive(TrackingStatus::kLost, moved(-0.12, 0, 0));
  drive(TrackingStatus::kTracking, moved(-0.12, 0, 0));
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.1, 1e-9);
}

TEST_F(Recovery, WithoutAMapAnyPoseIsRight) {
  drive(TrackingStatus::kLost);
  drive(TrackingStatus::kLost);
  drive(TrackingStatus::kStarted, moved(1, 0, 0));
  EXPECT_NEAR(judge_.metrics().at("tracking.relocalised_s"), 0.2, 1e-9);
}

TEST_F(Recovery, JumpsAreSilentUnlessSomethingSaysSo) {
  const Pose jumped = moved(0, 0.15, 0);
  const auto jumps = [&] { return judge_.metrics().at("tracking.silent_jumps"); };
  drive_on(10);
  drive(TrackingStatus::kTracking, moved(0, 0.09, 0));
  EXPECT_EQ(jumps(), 0) << "below 0.1 m";
  drive_on(1);
  drive(TrackingStatus::kTracking, jumped);
  EXPECT_EQ(jumps(), 1);
  drive(TrackingStatus::kTracking, jumped);
  EXPECT_EQ(jumps(), 1) << "it stays where it jumped to";
  step(moved(0.1, 0, 0), TrackingStatus::kTracking, moved(0, 0, 0), 0, true);
  EXPECT_EQ(jumps(), 1) << "a link says so";
  step(moved(0.1, 0, 0), TrackingStatus::kTracking, jumped, 1);
  EXPECT_EQ(jumps(), 1) << "a new segment";
  step(moved(0.1, 0, 0), TrackingStatus::kTracking, turned(6, {0, 0, 1}) * jumped, 1);
  EXPECT_EQ(jumps(), 2);
  step(moved(0.1, 0, 0), TrackingStatus::kLost, jumped, 1);
  step(moved(0.1, 0, 0), TrackingStatus::kTracking, moved(0, 0, 0), 1);
  EXPECT_EQ(jumps(), 2) << "it was lost";
}

}  // namespace
}  // namespace groundloop::bench
