#include "slam/pipeline/key_frame_window.h"

#include <gmock/gmock.h>

namespace groundloop::slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Feature feature(int64_t id, double u_px, const Eigen::Vector3d& p_kf) {
  Feature feature;
  feature.id = id;
  feature.left.uv_px = {static_cast<float>(u_px), 100};
  feature.right.uv_px = {static_cast<float>(u_px) - 10, 102};
  feature.p_kf = p_kf;
  feature.cofactor = u_px * equal_cofactor();
  return feature;
}

Pose at(double x_m) {
  Pose T = Pose::Identity();
  T.translation().x() = x_m;
  return T;
}

AdjustmentOptions three_key_frames() {
  AdjustmentOptions options;
  options.key_frames = 3;
  return options;
}

TEST(KeyFrameWindow, ALandmarkIsWhatTwoKeyFramesSaw) {
  KeyFrameWindow window(three_key_frames());
  window.add(5, at(0), {}, {feature(1, 50, {0, 0, 3}), feature(2, 60, {0, 1, 3})});
  EXPECT_THAT(window.problem({}).feature_ids, IsEmpty());
  window.add(6, at(1), {}, {feature(2, 70, {-1, 1, 3}), feature(3, 80, {0, 0, 4})});
  const WindowProblem asked = window.problem({});
  EXPECT_THAT(asked.key_frames, ElementsAre(5, 6));
  EXPECT_THAT(asked.feature_ids, ElementsAre(2));
  // Where the newest key frame believes it.
  EXPECT_LT((asked.problem.landmarks_odom[0] - Eigen::Vector3d(0, 1, 3)).norm(), 1e-12);
  ASSERT_THAT(asked.problem.observations, SizeIs(2));
  for (int k = 0; k < 2; ++k) {
    const AdjustmentObservation& seen = asked.problem.observations[k];
    EXPECT_EQ(seen.key_frame, k);
    EXPECT_EQ(seen.landmark, 0);
    const double u_px = k == 0 ? 60 : 70;
    EXPECT_LT((seen.uvu_px - Eigen::Vector3d(u_px, 101, u_px - 10)).norm(), 1e-5) << "mean of the rows";
    EXPECT_EQ(seen.sigma_px, three_key_frames().sigma_px);
    EXPECT_EQ(seen.cofactor, u_px * equal_cofactor()) << "that of the feature in this key frame";
  }
}

TEST(KeyFrameWindow, TheOldestIsAnchoredAndTheOldestLeaves) {
  KeyFrameWindow window(three_key_frames());
  for (int k = 0; k < 5; ++k) window.add(k, at(k), {}, {feature(7, 50 + k, {0, 0, 3})});
  EXPECT_EQ(window.size(), 3u);
  const WindowProblem asked = window.problem({});
  EXPECT_THAT(asked.key_frames, ElementsAre(2, 3, 4));
  EXPECT_TRUE(asked.problem.key_frames[0].fixed);
  EXPECT_FALSE(asked.problem.key_frames[1].fixed);
  EXPECT_FALSE(asked.problem.key_frames[2].fixed);
  window.clear();
  EXPECT_EQ(window.size(), 0u);
}

TEST(KeyFrameWindow, TakesOverRefinedPosesOfWhatIsStillThere) {
  KeyFrameWindow window(three_key_frames());
  for (int k = 0; k < 4; ++k) window.add(k, at(k), {}, {});
  window.refine({0, 1, 2}, {at(10), at(11), at(12)});
  const AdjustmentProblem problem = window.problem({}).problem;
  EXPECT_EQ(problem.key_frames[0].T_odom_left.translation().x(), 11);
  EXPECT_EQ(problem.key_frames[1].T_odom_left.translation().x(), 12);
  EXPECT_EQ(problem.key_frames[2].T_odom_left.translation().x(), 3);
}

TEST(KeyFrameWindow, ThePlanIsAPriorWhenItIsAskedFor) {
  AdjustmentOptions options = three_key_frames();
  KeyFrameWindow without(options);
  options.plan_sigma_ratio = 0.1;
  KeyFrameWindow with(options);
  for (KeyFrameWindow* window : {&without, &with}) {
    window->add(0, at(0), at(9), {});  // motion from a key frame that is not in the window
    window->add(1, at(1), at(0.9), {});
    window->add(2, at(2), std::nullopt, {});
  }
  EXPECT_THAT(without.problem({}).problem.motions, IsEmpty());
  const std::vector<MotionPrior> motions = with.problem({}).problem.motions;
  ASSERT_THAT(motions, SizeIs(1));
  EXPECT_EQ(motions[0].from, 0);
  EXPECT_EQ(motions[0].to, 1);
  EXPECT_EQ(motions[0].T_from_to.translation().x(), 0.9);
  EXPECT_NEAR(std::sqrt(motions[0].covariance(0, 0)), 0.09, 0.02);
}

}  // namespace
}  // namespace groundloop::slam
