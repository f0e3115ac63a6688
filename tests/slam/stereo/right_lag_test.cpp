#include "slam/stereo/right_lag.h"

#include <gtest/gtest.h>

#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

constexpr double kLate_s = 0.05;

class RightLagTest : public testing::Test {
 protected:
  RightLagTest() {
    rig_.cx_right_px = 318;
    velocity_ << 0.02, -0.01, 0.3, 0.03, 0.5, -0.02;
    points_left_ = {{0.4, 0.3, 1.5}, {-0.7, -0.4, 2}, {0.1, 0.2, 0.8}, {1.5, -1, 6}, {0, 0, 3}};
  }

  /// (u_left, v_left) of a point, and (u_right, v_right) by a camera that has gone on for late_s.
  Eigen::Vector4d seen(const Eigen::Vector3d& p_left, double late_s) const {
    const Pose T_left_late = se3_exp(late_s * velocity_);
    const Eigen::Vector3d now = rig_.project(p_left), then = rig_.project(T_left_late.inverse() * p_left);
    return {now.x(), now.y(), then.z(), then.y()};
  }

  StereoRig rig_ = centred_rig(640, 480, 577, 0.088);
  Vector6d velocity_;
  std::vector<Eigen::Vector3d> points_left_;
};

TEST_F(RightLagTest, ShiftsPointsToWhereTheCameraSeesThemLater) {
  for (const double late_s : {kLate_s, -kLate_s}) {
    const RightLag lag(velocity_, late_s);
    for (const Eigen::Vector3d& p_left : points_left_) {
      const Eigen::Vector2d shift = (seen(p_left, late_s) - seen(p_left, 0)).tail<2>();
      EXPECT_GT(shift.norm(), 1);
      EXPECT_LT((lag.shift_px(rig_, p_left).cast<double>() - shift).norm(), 1e-4) << p_left.transpose();
    }
  }
}

TEST_F(RightLagTest, FindsThePointOfANewMatchWithItsShift) {
  const RightLag lag(velocity_, kLate_s);
  for (const Eigen::Vector3d& p_left : points_left_) {
    const Eigen::Vector4f found = seen(p_left, kLate_s).cast<float>();
    const Eigen::Vector2f shift = lag.shift_px(rig_, found.head<2>(), found.tail<2>());
    EXPECT_LT((shift - lag.shift_px(rig_, p_left)).norm(), 0.01) << p_left.transpose();
  }
}

TEST_F(RightLagTest, TheRowsFlowAsTheShiftGrows) {
  constexpr double kMoment_s = 1e-4;
  const RightLag lag(velocity_, kLate_s);
  for (const Eigen::Vector3d& p_left : points_left_) {
    const double moved_px = seen(p_left, kLate_s + kMoment_s)(3) - seen(p_left, kLate_s - kMoment_s)(3);
    EXPECT_NEAR(lag.row_flow_px_per_s(rig_, p_left), moved_px / (2 * kMoment_s), 1e-3);
  }
}

TEST_F(RightLagTest, NothingShiftsWithoutLagOrAtRestOrBehindTheCamera) {
  const Eigen::Vector2f left(300, 200), right(280, 200);
  for (const RightLag& lag : {RightLag(), RightLag(velocity_, 0), RightLag(Vector6d::Zero(), kLate_s)}) {
    EXPECT_EQ(lag.shift_px(rig_, points_left_[0]).norm(), 0);
    EXPECT_EQ(lag.shift_px(rig_, left, right).norm(), 0);
  }
  const RightLag lag(velocity_, kLate_s);
  EXPECT_EQ(lag.shift_px(rig_, {0.1, 0.1, -1}).norm(), 0);
  EXPECT_EQ(lag.row_flow_px_per_s(rig_, {0.1, 0.1, -1}), 0);
}

}  // namespace
}  // namespace groundloop::slam
