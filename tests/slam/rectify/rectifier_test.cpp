#include "slam/rectify/rectifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

const cv::Size kSize(320, 240);

StereoCalibration toed_in() {
  StereoCalibration c;
  c.file = "stereo.yml";
  c.M1 = {280, 0, 163, 0, 282, 118, 0, 0, 1};
  c.M2 = {283, 0, 157, 0, 284, 121, 0, 0, 1};
  c.D1 = {-0.18, 0.06, 8e-4, -5e-4, 0};
  c.D2 = {-0.2, 0.07, -6e-4, 3e-4, 0};
  cv::Rodrigues(cv::Vec3d(0.012, -0.02, 0.015), c.R);
  c.T = {-0.12, 0.002, -0.003};
  return c;
}

/// A soft dot in a raw image where a camera sees a point of its own frame.
cv::Mat raw_dot(const cv::Matx33d& M, const std::vector<double>& D, const cv::Vec3d& p_camera) {
  std::vector<cv::Point2d> uv;
  cv::projectPoints(std::vector<cv::Point3d>{{p_camera[0], p_camera[1], p_camera[2]}}, cv::Vec3d(),
                    cv::Vec3d(), M, D, uv);
  cv::Mat image(kSize, CV_8UC1);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double r2 = (u - uv[0].x) * (u - uv[0].x) + (v - uv[0].y) * (v - uv[0].y);
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(240 * std::exp(-r2 / (2 * 2.5 * 2.5)));
    }
  }
  return image;
}

Eigen::Vector2d centroid(const cv::Mat& image) {
  const cv::Moments m = cv::moments(image);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

TEST(Rectifier, PointsComeToLieWhereTheRigSaysTheyDo) {
  const StereoCalibration c = toed_in();
  const Rectifier rectifier(c, kSize);
  const StereoRig& rig = rectifier.rig();
  EXPECT_NEAR(rig.baseline_m, cv::norm(c.T), 1e-9);
  for (const cv::Vec3d& p_raw :
       {cv::Vec3d(0.05, 0.02, 1.0), cv::Vec3d(-0.5, -0.35, 1.6), cv::Vec3d(0.7, 0.4, 2.0)}) {
    const cv::Mat raw_left = raw_dot(c.M1, c.D1, p_raw), raw_right = raw_dot(c.M2, c.D2, c.R * p_raw + c.T);
    cv::Mat left, right;
    rectifier.rectify(raw_left, raw_right, left, right);
    const Eigen::Vector3d p_left =
        rectifier.T_raw_left().inverse() * Eigen::Vector3d(p_raw[0], p_raw[1], p_raw[2]);
    const Eigen::Vector3d uvu = rig.project(p_left);
    const Eigen::Vector2d uv_left = centroid(left), uv_right = centroid(right);
    EXPECT_NEAR(uv_left.x(), uvu.x(), 0.05);
    EXPECT_NEAR(uv_left.y(), uvu.y(), 0.05);
    EXPECT_NEAR(uv_right.x(), uvu.z(), 0.05);
    EXPECT_NEAR(uv_right.y(), uvu.y(), 0.05);
  }
}

TEST(Rectifier, AnIdealPairStaysAsItIs) {
  StereoCalibration c;
  c.M1 = c.M2 = {280, 0, 159.5, 0, 280, 119.5, 0, 0, 1};
  c.D1 = c.D2 = {0, 0, 0, 0};
  c.R = cv::Matx33d::eye();
  c.T = {-0.1, 0, 0};
  const cv::Matx34d P1(280, 0, 159.5, 0, 0, 280, 119.5, 0, 0, 0, 1, 0);
  cv::Matx34d P2 = P1;
  P2(0, 3) = -28;
  c.chosen = {c.R, c.R, P1, P2};
  const Rectifier rectifier(c, kSize);
  EXPECT_TRUE(rectifier.T_raw_left().isApprox(Pose::Identity()));
  EXPECT_NEAR(rectifier.rig().baseline_m, 0.1, 1e-12);
  cv::Mat raw(kSize, CV_8UC1), left, right;
  cv::randu(raw, 0, 256);
  rectifier.rectify(raw, raw, left, right);
  EXPECT_EQ(cv::norm(raw, left, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(raw, right, cv::NORM_INF), 0);
}

TEST(Rectifier, RefusesOtherSizesAndACameraOnTheWrongSide) {
  StereoCalibration c = toed_in();
  c.size = cv::Size(640, 480);
  const auto message = [&c] {
    try {
      const Rectifier rectifier(c, kSize);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(),
            "stereo.yml: image_width, image_height: 640x480: wanted 320x240, the size of the images");
  c.size.reset();
  c.T = -c.T;
  EXPECT_THAT(message(), testing::EndsWith("wanted a camera to the right of the left one"));
}

}  // namespace
}  // namespace groundloop::slam
