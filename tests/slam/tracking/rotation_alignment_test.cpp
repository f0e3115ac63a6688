#include "slam/tracking/rotation_alignment.h"

#include <gtest/gtest.h>

#include <numbers>

#include "slam/types/pose.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

Eigen::Matrix3d turn(double tilt_deg, double pan_deg, double roll_deg) {
  return so3_exp(Eigen::Vector3d(tilt_deg, pan_deg, roll_deg) * kDeg);
}

/// A camera that turns on the spot inside a painted sphere.
class RotationAlignmentTest : public testing::Test {
 protected:
  RotationAlignmentTest() {
    rig_.width_px = 320;
    rig_.height_px = 240;
    rig_.fx_px = rig_.fy_px = 290;
    rig_.cx_px = rig_.cx_right_px = 161.5;
    rig_.cy_px = 117.5;
    rig_.baseline_m = 0.1;
  }

  ImagePyramid look(const Eigen::Matrix3d& R_world_camera, const Light& light = {}) const {
    ImagePyramid pyramid;
    pyramid.build(draw({rig_.width_px, rig_.height_px}, light,
                       [&](int u, int v) {
                         const Eigen::Vector3d ray((u - rig_.cx_px) / rig_.fx_px,
                                                   (v - rig_.cy_px) / rig_.fy_px, 1);
                         return sphere_.at(R_world_camera * ray.normalized());
                       }),
                  4);
    return pyramid;
  }

  double error_deg(const Eigen::Matrix3d& R_previous_left, const Eigen::Matrix3d& start,
                   const Light& light = {}) const {
    RotationAlignment alignment(rig_);
    alignment.remember(look(Eigen::Matrix3d::Identity()));
    const Eigen::Matrix3d found = alignment.align(look(R_previous_left, light), start);
    return rotation_angle_rad(found.transpose() * R_previous_left) / kDeg;
  }

  StereoRig rig_;
  const Texture sphere_{31, 0.15, 0.8};  // wave lengths on the unit sphere
};

TEST_F(RotationAlignmentTest, FindsRollAndPanWithoutAPlan) {
  EXPECT_LT(error_deg(turn(0, 4, 8), Eigen::Matrix3d::Identity()), 0.3);
}

TEST_F(RotationAlignmentTest, FindsTurnsAboutEveryAxis) {
  for (const Eigen::Vector3d& deg :
       {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(-3, 0, 0), Eigen::Vector3d(0, 4, 0),
        Eigen::Vector3d(0, -4, 0), Eigen::Vector3d(0, 0, 8), Eigen::Vector3d(0, 0, -8),
        Eigen::Vector3d(1, -2, 3)}) {
    EXPECT_LT(error_deg(turn(deg.x(), deg.y(), deg.z()), Eigen::Matrix3d::Identity()), 0.3)
        << deg.transpose();
  }
}

TEST_F(RotationAlignmentTest, AGoodStartReachesFarther) {
  // A third of the image is gone; what is left has another mean, which costs accuracy.
  EXPECT_LT(error_deg(turn(0, 15, 0), turn(0, 12, 1)), 1);
}

TEST_F(RotationAlignmentTest, StandingStillStaysStill) {
  EXPECT_LT(error_deg(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()), 0.01);
}

TEST_F(RotationAlignmentTest, BrightnessAndNoiseDoNotMatter) {
  EXPECT_LT(error_deg(turn(0, 3, -5), Eigen::Matrix3d::Identity(), {1.05, 12, 2, 4}), 0.3);
}

TEST_F(RotationAlignmentTest, AFlatImageLeavesThePrediction) {
  RotationAlignment alignment(rig_);
  ImagePyramid flat;
  flat.build(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), 4);
  alignment.remember(flat);
  const Eigen::Matrix3d predicted = turn(1, 2, 3);
  EXPECT_LT(rotation_angle_rad(alignment.align(flat, predicted).transpose() * predicted), 1e-9);
}

TEST_F(RotationAlignmentTest, WithoutAPreviousImageThePredictionStands) {
  RotationAlignment alignment(rig_);
  const Eigen::Matrix3d predicted = turn(1, 2, 3);
  EXPECT_EQ(alignment.align(look(Eigen::Matrix3d::Identity()), predicted), predicted);
}

}  // namespace
}  // namespace groundloop::slam
