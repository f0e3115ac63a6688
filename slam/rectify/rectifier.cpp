#include "slam/rectify/rectifier.h"

#include <fmt/format.h>

#include <chrono>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

std::string text_of(cv::Size size) { return fmt::format("{}x{}", size.width, size.height); }

ChosenRectification choose(const StereoCalibration& c, cv::Size size) {
  ChosenRectification chosen;
  cv::Matx44d Q;
  cv::stereoRectify(c.M1, c.D1, c.M2, c.D2, size, c.R, c.T, chosen.R1, chosen.R2, chosen.P1, chosen.P2, Q,
                    cv::CALIB_ZERO_DISPARITY, 0);
  return chosen;
}

}  // namespace

Rectifier::Rectifier(const StereoCalibration& calibration, cv::Size size) : size_(size) {
  if (calibration.size && *calibration.size != size) {
    throw InputError(Problem{calibration.file, 0, "image_width, image_height", text_of(*calibration.size),
                             text_of(size) + ", the size of the images"});
  }
  const ChosenRectification chosen = calibration.chosen ? *calibration.chosen : choose(calibration, size);
  const cv::Matx34d &P1 = chosen.P1, &P2 = chosen.P2;
  cv::initUndistortRectifyMap(calibration.M1, calibration.D1, chosen.R1, P1, size, CV_16SC2, left_map_[0],
                              left_map_[1]);
  cv::initUndistortRectifyMap(calibration.M2, calibration.D2, chosen.R2, P2, size, CV_16SC2, right_map_[0],
                              right_map_[1]);
  rig_.width_px = size.width, rig_.height_px = size.height;
  rig_.fx_px = P1(0, 0), rig_.fy_px = P1(1, 1);
  rig_.cx_px = P1(0, 2), rig_.cy_px = P1(1, 2), rig_.cx_right_px = P2(0, 2);
  rig_.baseline_m = -P2(0, 3) / P2(0, 0);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) T_raw_left_.linear()(col, row) = chosen.R1(row, col);
  }
  if (!(rig_.baseline_m > 0)) {
    throw InputError(Problem{calibration.file, 0, calibration.chosen ? "P2" : "T",
                             fmt::format("baseline {} m", rig_.baseline_m),
                             "a camera to the right of the left one"});
  }
}

void Rectifier::rectify(const cv::Mat& raw_left, const cv::Mat& raw_right, cv::Mat& left,
                        cv::Mat& right) const {
  CV_Assert(raw_left.size() == size_ && raw_right.size() == size_);
  cv::remap(raw_left, left, left_map_[0], left_map_[1], cv::INTER_LINEAR);
  cv::remap(raw_right, right, right_map_[0], right_map_[1], cv::INTER_LINEAR);
}

void Rectifier::rectify(const cv::Mat& raw_left, const cv::Mat& raw_right, StereoFrame& frame) const {
  const auto start = std::chrono::steady_clock::now();
  rectify(raw_left, raw_right, frame.left, frame.right);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  frame.rectification_ms = took.count();
}

}  // namespace groundloop::slam
