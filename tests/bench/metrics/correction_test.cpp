#include "bench/metrics/correction.h"

#include <gtest/gtest.h>

#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using slam::FrameResult;
using slam::Pose;
using slam::Trajectory;

/// The camera drives a circle. The odometry turns too far by a little at every step; at frame 80 a link
/// enters and the estimate jumps onto the truth, where it stays; the final trajectory is the truth.
struct Drive {
  Drive() {
    const Pose T_wrong_step = turned(0.05, {0, 0, 1});
    for (size_t i = 0; i < truth.size(); ++i) {
      odometry.push_back(truth[i]);
      if (i > 0) odometry[i].T = odometry[i - 1].T * (truth[i - 1].T.inverse() * truth[i].T) * T_wrong_step;
      FrameResult frame;
      frame.index = static_cast<int64_t>(i);
      frame.stamp_ns = truth[i].stamp_ns;
      frame.T_map_left = odometry[i].T;
      frames.push_back(frame);
    }
  }
  void close_loop(size_t at_frame) {
    frames[at_frame].links.emplace_back();
    for (size_t i = at_frame; i < frames.size(); ++i) frames[i].T_map_left = truth[i].T;
  }
  Trajectory truth = circle(100, 3), odometry;
  std::vector<FrameResult> frames;
};

TEST(Correction, WithoutLinksThereIsNothingToUndo) {
  const Drive drive;
  EXPECT_TRUE(without_links(drive.frames, drive.truth).empty());
  EXPECT_TRUE(correction_metrics(drive.truth, {}, drive.truth).empty());
}

TEST(Correction, UndoingTheJumpGivesTheOdometryBack) {
  Drive drive;
  drive.close_loop(80);
  const Trajectory before = without_links(drive.frames, drive.truth);
  ASSERT_EQ(before.size(), drive.odometry.size());
  for (size_t i = 0; i < 80; ++i) {
    EXPECT_TRUE(before[i].T.isApprox(drive.odometry[i].T, 1e-12)) << i;
    EXPECT_EQ(before[i].stamp_ns, drive.truth[i].stamp_ns);
  }
  // from there on as the truth moves, from where the odometry had come to
  for (size_t i = 80; i < 100; ++i) {
    const Pose T = drive.odometry[79].T * drive.truth[79].T.inverse() * drive.truth[i].T;
    EXPECT_TRUE(before[i].T.isApprox(T, 1e-12)) << i;
  }
  const Metrics metrics = correction_metrics(drive.truth, before, drive.truth);
  EXPECT_GT(metrics.at("loop.ate_before_m"), 0.01);
  EXPECT_LT(metrics.at("loop.ate_after_m"), 1e-9);
}

}  // namespace
}  // namespace groundloop::bench
