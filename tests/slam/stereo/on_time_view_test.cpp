#include "slam/stereo/on_time_view.h"

#include <gtest/gtest.h>

#include "tests/slam/stereo/late_pair.h"

namespace groundloop::slam {
namespace {

constexpr double kAnyDepth_m = 1e9;

class OnTimeViewTest : public testing::Test {
 protected:
  OnTimeViewTest() { rig_.cx_right_px = 318; }

  /// Where the late right image shows a point, (u, v, 1).
  Eigen::Vector3d late_px(const RightLag& lag, const Eigen::Vector3d& p_left) const {
    const Eigen::Vector3d uvu = rig_.project(lag.T_late_left() * p_left);
    return {uvu.z(), uvu.y(), 1};
  }
  Eigen::Vector2d view_px(const OnTimeView& view, const Eigen::Vector3d& late_px) const {
    return (view.late_of_view().inverse() * late_px).hnormalized();
  }
  Eigen::Vector2d right_px(const Eigen::Vector3d& p_left) const {
    return {rig_.project(p_left).z(), rig_.project(p_left).y()};
  }

  StereoRig rig_ = centred_rig(640, 480, 577, 0.088);
  Vector6d velocity_{0.02, -0.01, 0.3, 0.03, 0.5, -0.02};
  std::vector<Eigen::Vector3d> points_left_ = {{0.4, 0.3, 1.5}, {-0.7, -0.4, 2}, {0.1, 0.2, 0.8},
                                               {1.5, -1, 6},    {0, 0, 3},       {-20, 9, 60}};
};

TEST_F(OnTimeViewTest, TheColumnsOfAMatchTellItsDepthExactlyWhateverThePlane) {
  for (const double late_s : {0.05, -0.03, 0.1}) {
    const RightLag lag(velocity_, late_s);
    for (const double plane_m : {0.8, 2.0, 7.0, kAnyDepth_m}) {
      const OnTimeView view(rig_, lag, plane_m);
      for (const Eigen::Vector3d& p_left : points_left_) {
        const Eigen::Vector3d uvu = rig_.project(p_left);
        const double u_view_px = view_px(view, late_px(lag, p_left)).x();
        EXPECT_NEAR(view.disparity_px(uvu.x(), u_view_px), uvu.x() - uvu.z(), 1e-6) << p_left.transpose();
      }
    }
  }
}

TEST_F(OnTimeViewTest, WhatIsOnThePlaneIsWhereItWouldBeInTime) {
  const RightLag lag(velocity_, 0.05);
  for (const Eigen::Vector3d& p_left : points_left_) {
    const OnTimeView view(rig_, lag, p_left.z());
    EXPECT_GT((late_px(lag, p_left).head<2>() - right_px(p_left)).norm(), 5);
    EXPECT_LT((view_px(view, late_px(lag, p_left)) - right_px(p_left)).norm(), 1e-6);
  }
}

TEST_F(OnTimeViewTest, ATurnAboutTheRightCameraIsPutBackAtAnyDepth) {
  Vector6d turning = Vector6d::Zero();
  turning.tail<3>() << 0.1, 0.5, -0.05;
  turning.head<3>() = -turning.tail<3>().cross(Eigen::Vector3d(rig_.baseline_m, 0, 0));
  const RightLag lag(turning, 0.05);
  const OnTimeView view(rig_, lag, 2);
  for (const Eigen::Vector3d& p_left : points_left_)
    EXPECT_LT((view_px(view, late_px(lag, p_left)) - right_px(p_left)).norm(), 1e-6);
}

TEST_F(OnTimeViewTest, WithoutLagNothingChanges) {
  const OnTimeView view(rig_, RightLag(velocity_, 0), 2);
  EXPECT_TRUE(view.late_of_view().isIdentity(1e-12));
  EXPECT_NEAR(view.disparity_px(300, 280), 20, 1e-9);
}

TEST(OnTimeViewPicture, IsThatOfARightCameraInTime) {
  const LatePair pair;
  const Eigen::Vector2i first(300, 90);  // on the wall
  const double depth_m = pair.rig.fx_px * pair.rig.baseline_m / pair.disparity_px(first.x() + 20, first.y());
  const OnTimeView view(pair.rig, pair.lag, depth_m);
  cv::Mat drawn(12, 16, CV_8UC1);
  ASSERT_TRUE(view.draw(pair.right, first, drawn));
  double worst_grey = 0, worst_undone_grey = 0;
  for (int v = 0; v < drawn.rows; ++v) {
    for (int u = 0; u < drawn.cols; ++u) {
      const int in_time = pair.right_in_time.at<uint8_t>(first.y() + v, first.x() + u);
      const int late = pair.right.at<uint8_t>(first.y() + v, first.x() + u);
      worst_grey = std::max<double>(worst_grey, std::abs(drawn.at<uint8_t>(v, u) - in_time));
      worst_undone_grey = std::max<double>(worst_undone_grey, std::abs(late - in_time));
    }
  }
  EXPECT_LT(worst_grey, 6);
  EXPECT_GT(worst_undone_grey, 40);
  EXPECT_FALSE(view.draw(pair.right, {-40, 90}, drawn)) << "which the late image does not show";
}

}  // namespace
}  // namespace groundloop::slam
