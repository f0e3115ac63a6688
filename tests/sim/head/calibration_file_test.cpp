#include "sim/head/calibration_file.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "slam/rectify/stereo_calibration.h"

namespace groundloop::sim {
namespace {

HeadModel toed_out_head() {
  HeadModel head;
  head.baseline_m = 0.09;
  head.raw.emplace();
  head.raw->optics.left = {.fx_px = 570,
                           .fy_px = 572,
                           .cx_px = 310,
                           .cy_px = 245,
                           .k1 = -0.2,
                           .k2 = 0.1,
                           .p1 = 1e-3,
                           .p2 = -2e-3,
                           .k3 = 0.01};
  head.raw->optics.right = {.fx_px = 575, .fy_px = 573, .cx_px = 325, .cy_px = 235, .k1 = -0.18};
  head.raw->right_pose = {
      .down_m = 0.001, .forward_m = -0.002, .pan_deg = 1, .tilt_deg = 0.5, .roll_deg = -0.7};
  return head;
}

TEST(CalibrationFile, TellsTheCoreTheHead) {
  const HeadModel head = toed_out_head();
  const auto told = slam::parse_stereo_calibration(calibration_yaml(head), "head");
  EXPECT_EQ(told.size.value(), cv::Size(640, 480));
  EXPECT_EQ(told.M1, cv::Matx33d(570, 0, 310, 0, 572, 245, 0, 0, 1));
  EXPECT_EQ(told.M2, cv::Matx33d(575, 0, 325, 0, 573, 235, 0, 0, 1));
  EXPECT_EQ(told.D1, (std::vector<double>{-0.2, 0.1, 1e-3, -2e-3, 0.01}));
  // x_right = R x_left + T for a point that both see
  const Eigen::Vector3d p_left(0.3, -0.2, 2), p_right = head.T_left_right().inverse() * p_left;
  const cv::Vec3d transformed = told.R * cv::Vec3d(0.3, -0.2, 2) + told.T;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(transformed[i], p_right[i], 1e-12);
}

TEST(CalibrationFile, IsWrongByWhatIsConfigured) {
  HeadModel head = toed_out_head();
  const auto exact = slam::parse_stereo_calibration(calibration_yaml(head), "head");
  CalibrationError& error = head.raw->calibration_error;
  error.left = {.fx_px = 1, .cy_px = -2, .p2 = 0.001};
  error.right = {.fy_px = -1.5, .cx_px = 0.5, .k1 = 0.01};
  error.baseline_m = 0.0004;
  error.right_pose.pan_deg = 0.25;
  const auto told = slam::parse_stereo_calibration(calibration_yaml(head), "head");
  EXPECT_DOUBLE_EQ(told.M1(0, 0), 571);
  EXPECT_DOUBLE_EQ(told.M1(1, 2), 243);
  EXPECT_DOUBLE_EQ(told.D1[3], -1e-3);
  EXPECT_DOUBLE_EQ(told.M2(1, 1), 571.5);
  EXPECT_DOUBLE_EQ(told.M2(0, 2), 325.5);
  EXPECT_DOUBLE_EQ(told.D2[0], -0.17);
  EXPECT_NEAR(cv::norm(told.T), std::hypot(0.0904, 0.001, 0.002), 1e-12);
  const double turned_rad = std::acos(0.5 * (cv::trace(told.R.t() * exact.R) - 1));
  EXPECT_NEAR(turned_rad, 0.25 * M_PI / 180, 1e-9);
}

}  // namespace
}  // namespace groundloop::sim
