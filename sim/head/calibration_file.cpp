#include "sim/head/calibration_file.h"

#include <opencv2/core.hpp>

namespace groundloop::sim {
namespace {

Lens told(Lens lens, const LensError& error) {
  lens.fx_px += error.fx_px, lens.fy_px += error.fy_px;
  lens.cx_px += error.cx_px, lens.cy_px += error.cy_px;
  lens.k1 += error.k1, lens.k2 += error.k2, lens.k3 += error.k3;
  lens.p1 += error.p1, lens.p2 += error.p2;
  return lens;
}

RightPose told(RightPose pose, const RightPose& error) {
  pose.down_m += error.down_m, pose.forward_m += error.forward_m;
  pose.pan_deg += error.pan_deg, pose.tilt_deg += error.tilt_deg, pose.roll_deg += error.roll_deg;
  return pose;
}

cv::Mat camera_matrix(const Lens& lens) {
  return (cv::Mat_<double>(3, 3) << lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
}

cv::Mat distortion(const Lens& lens) {
  return (cv::Mat_<double>(1, 5) << lens.k1, lens.k2, lens.p1, lens.p2, lens.k3);
}

}  // namespace

std::string calibration_yaml(const HeadModel& head) {
  const RawHead& raw = head.raw.value();
  const CalibrationError& error = raw.calibration_error;
  const Lens left = told(raw.optics.left, error.left), right = told(raw.optics.right, error.right);
  const slam::Pose T_right_left =
      T_left_right(head.baseline_m + error.baseline_m, told(raw.right_pose, error.right_pose)).inverse();
  cv::Mat R(3, 3, CV_64F), T(3, 1, CV_64F);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) R.at<double>(row, col) = T_right_left.linear()(row, col);
    T.at<double>(row) = T_right_left.translation()[row];
  }
  cv::FileStorage file(".yml",
                       cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  file << "image_width" << head.width_px << "image_height" << head.height_px;
  file << "M1" << camera_matrix(left) << "D1" << distortion(left);
  file << "M2" << camera_matrix(right) << "D2" << distortion(right);
  file << "R" << R << "T" << T;
  return file.releaseAndGetString();
}

}  // namespace groundloop::sim
