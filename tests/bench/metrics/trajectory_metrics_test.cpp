#include "bench/metrics/trajectory_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using slam::TrackingStatus;
using testing::Contains;
using testing::Key;
using testing::Not;

constexpr double kStep_m = 0.375;  // exact in binary, so that lengths are
constexpr int kPoses = 33;         // 12 m

/// Along x; the estimate's steps are longer by 1 % and it turns left by 0.75 degrees a step (2 degrees a
/// metre) on its spot, so that only its heading shows it.
PosePairs drifting() {
  PosePairs pairs{straight(kPoses, kStep_m), {}};
  slam::Pose T = slam::Pose::Identity();
  for (int i = 0; i < kPoses; ++i) {
    pairs.estimate.push_back(at(i, T));
    T = T * moved(1.01 * kStep_m, 0, 0) * turned(2 * kStep_m, Eigen::Vector3d::UnitZ());
  }
  return pairs;
}

/// Mean over every start and length of what happens over a piece: pieces end at the first pose beyond the
/// length.
template <class Error>
double mean_over_pieces(const std::vector<int>& lengths_m, Error error_of) {
  double sum = 0;
  int pieces = 0;
  for (const int length_m : lengths_m) {
    const int steps = static_cast<int>(std::floor(length_m / kStep_m)) + 1;
    for (int start = 0; start + steps < kPoses; ++start, ++pieces) sum += error_of(steps) / length_m;
  }
  return sum / pieces;
}

TEST(Drift, OfAScaleErrorIsItsPercentage) {
  const PosePairs pairs{straight(kPoses, kStep_m), straight(kPoses, 1.01 * kStep_m)};
  const auto found = drift(pairs, {1, 2, 3, 4, 5, 6, 7, 8});
  ASSERT_TRUE(found);
  const auto error_m = [](int steps) { return 0.01 * steps * kStep_m; };
  EXPECT_NEAR(found->trans_percent, 100 * mean_over_pieces({1, 2, 3, 4, 5, 6, 7, 8}, error_m), 1e-10);
  EXPECT_NEAR(found->rot_deg_per_m, 0, 1e-10);
}

TEST(Drift, OfATurnIsItsAngleByLength) {
  const auto found = drift(drifting(), {1, 5});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rot_deg_per_m, mean_over_pieces({1, 5}, [](int steps) { return 2 * kStep_m * steps; }),
              1e-10);
  EXPECT_EQ(found->sub_trajectories, static_cast<size_t>((kPoses - 3) + (kPoses - 14)));
}

TEST(Drift, OfTooShortAPathIsNotMeasured) {
  EXPECT_FALSE(drift({straight(3, 0.375), straight(3, 0.375)}, {1}));
  EXPECT_FALSE(drift({}, {1}));
}

TEST(EndError, FirstPosesAreLaidOnEachOther) {
  // The estimate is in a frame of its own and ends 3-4 beside the truth, 5 degrees to the left.
  PosePairs pairs{straight(5, 1), straight(5, 1)};
  pairs.estimate.back().T = pairs.estimate.back().T * moved(3, 4, 0) * turned(5, Eigen::Vector3d::UnitZ());
  for (auto& pose : pairs.estimate) pose.T = moved(9, 9, 9) * turned(70, {1, 2, 3}) * pose.T;
  const EndError error = end_error(pairs, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(error.distance_m, 5, 1e-12);
  EXPECT_NEAR(error.yaw_deg, 5, 1e-10);
}

TEST(EndError, YawIsAboutTheVerticalAlone) {
  PosePairs pairs{straight(2, 1), straight(2, 1)};
  pairs.estimate.back().T = pairs.estimate.back().T * turned(7, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(end_error(pairs, Eigen::Vector3d::UnitZ()).yaw_deg, 0, 1e-12);
  EXPECT_NEAR(end_error(pairs, -Eigen::Vector3d::UnitX()).yaw_deg, 7, 1e-12);
}

TEST(EndError, YawOfACameraIsThatOfItsBody) {
  // The same turn seen by a camera (x right, y down, z forward): about the world's vertical, not the camera's
  // axes.
  Eigen::Matrix3d R_body_left;
  R_body_left << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  slam::Pose T_body_left = moved(0.1, 0.04, 0.35);
  T_body_left.linear() = R_body_left;
  PosePairs pairs{straight(2, 1), straight(2, 1)};
  pairs.estimate.back().T = pairs.estimate.back().T * turned(-12, Eigen::Vector3d::UnitZ());
  for (auto* trajectory : {&pairs.truth, &pairs.estimate}) {
    for (auto& pose : *trajectory) pose.T = pose.T * T_body_left;
  }
  EXPECT_NEAR(end_error(pairs, Eigen::Vector3d::UnitZ()).yaw_deg, 12, 1e-10);
}

TEST(EndError, YawKnowsNoDirectionAndStaysBelowAHalfTurn) {
  PosePairs pairs{straight(2, 1), straight(2, 1)};
  pairs.estimate.back().T = pairs.estimate.back().T * turned(190, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(end_error(pairs, Eigen::Vector3d::UnitZ()).yaw_deg, 170, 1e-10);
}

TEST(TrajectoryMetrics, HaveTheNamesOfTheDesign) {
  const Metrics metrics = trajectory_metrics(drifting());
  for (const char* name : {"ate_rmse_m", "ate_max_m", "rpe_trans_percent", "rpe_rot_deg_per_m",
                           "drift_5m_percent", "end_error_m", "end_yaw_deg", "length_m"}) {
    EXPECT_THAT(metrics, Contains(Key(std::string("trajectory.") + name)));
  }
  EXPECT_EQ(metrics.size(), 8u);
  EXPECT_NEAR(metrics.at("trajectory.length_m"), 12, 1e-12);
  EXPECT_NEAR(metrics.at("trajectory.end_yaw_deg"), 24, 1e-9);
}

TEST(TrajectoryMetrics, AteIsAlignedWithoutScale) {
  // A line with a scale error of 10 %: after alignment of the centres the ends of the 12 m are 0.6 m off, and
  // the rms of steps -16..16 is 0.0375 * sqrt((33^2 - 1) / 12).
  PosePairs pairs{straight(kPoses, kStep_m), straight(kPoses, 1.1 * kStep_m)};
  for (auto& pose : pairs.estimate) pose.T = moved(1, 2, 3) * turned(50, {3, 2, 1}) * pose.T;
  const Metrics metrics = trajectory_metrics(pairs);
  EXPECT_NEAR(metrics.at("trajectory.ate_max_m"), 0.6, 1e-12);
  EXPECT_NEAR(metrics.at("trajectory.ate_rmse_m"), 0.0375 * std::sqrt(1088.0 / 12), 1e-12);
}

TEST(TrajectoryMetrics, OfAPerfectEstimateAreZero) {
  const PosePairs pairs{circle(60, 3), circle(60, 3)};
  for (const auto& [name, value] : trajectory_metrics(pairs)) {
    EXPECT_NEAR(value, name == "trajectory.length_m" ? 59 * 6 * std::sin(3 * kRadPerDeg) : 0, 1e-9) << name;
  }
}

TEST(TrajectoryMetrics, LeaveOutWhatThePathIsTooShortFor) {
  const Metrics metrics = trajectory_metrics({straight(3, 0.1), straight(3, 0.1)});
  EXPECT_THAT(metrics, Not(Contains(Key("trajectory.rpe_trans_percent"))));
  EXPECT_THAT(metrics, Not(Contains(Key("trajectory.drift_5m_percent"))));
  EXPECT_THAT(metrics, Contains(Key("trajectory.ate_rmse_m")));
  EXPECT_TRUE(trajectory_metrics({}).empty());
}

TEST(TrajectoryMetrics, OfOnePoseAreZero) {
  const Metrics metrics = trajectory_metrics({straight(1, 1), straight(1, 1)});
  EXPECT_EQ(metrics.at("trajectory.ate_rmse_m"), 0);
  EXPECT_EQ(metrics.at("trajectory.length_m"), 0);
}

std::vector<slam::FrameResult> frames_of(const std::vector<TrackingStatus>& statuses) {
  std::vector<slam::FrameResult> frames(statuses.size());
  for (size_t i = 0; i < frames.size(); ++i) frames[i].status = statuses[i];
  return frames;
}

TEST(TrackingMetrics, CountLostFramesAndThoseWithAPoseFromVision) {
  // lost for two frames, then a new segment that starts from the plan; then a pair that is repeated
  const Metrics metrics =
      tracking_metrics(frames_of({TrackingStatus::kStarted, TrackingStatus::kTracking, TrackingStatus::kLost,
                                  TrackingStatus::kLost, TrackingStatus::kStarted, TrackingStatus::kTracking,
                                  TrackingStatus::kRepeated, TrackingStatus::kTracking}));
  EXPECT_EQ(metrics.at("trajectory.lost_frames"), 2);
  EXPECT_DOUBLE_EQ(metrics.at("trajectory.completeness"), 4.0 / 8);
}

TEST(TrackingMetrics, OfARunWithoutLossesAreComplete) {
  const Metrics metrics = tracking_metrics(frames_of({TrackingStatus::kStarted, TrackingStatus::kTracking}));
  EXPECT_EQ(metrics.at("trajectory.lost_frames"), 0);
  EXPECT_EQ(metrics.at("trajectory.completeness"), 1);
  EXPECT_EQ(metrics.at("tracking.row_offset_px"), 0);
  EXPECT_EQ(metrics.at("tracking.right_late_s"), 0);
  EXPECT_TRUE(tracking_metrics({}).empty());
}

TEST(TrackingMetrics, TellTheRowOffsetOfTheEnd) {
  std::vector<slam::FrameResult> frames = frames_of({TrackingStatus::kStarted, TrackingStatus::kTracking});
  frames.back().row_offset_px = 1.2;
  EXPECT_EQ(tracking_metrics(frames).at("tracking.row_offset_px"), 1.2);
}

TEST(TrackingMetrics, TellTheLongestDelayOfTheRun) {
  std::vector<slam::FrameResult> frames =
      frames_of({TrackingStatus::kStarted, TrackingStatus::kTracking, TrackingStatus::kTracking});
  frames[0].right_late_s = 0.01;
  frames[1].right_late_s = -0.02;
  EXPECT_EQ(tracking_metrics(frames).at("tracking.right_late_s"), -0.02);
}

}  // namespace
}  // namespace groundloop::bench
