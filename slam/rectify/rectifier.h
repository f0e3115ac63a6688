#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

#include "slam/rectify/stereo_calibration.h"
#include "slam/types/stereo_frame.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Makes a rectified pair of a raw one: distortion removed, both cameras turned so that their rows agree.
/// Bilinear, in fixed point, by maps made once (cv::remap).
class Rectifier {
 public:
  /// Takes the rotations and projections that the calibration has, or else makes them (cv::stereoRectify with
  /// CALIB_ZERO_DISPARITY and alpha 0: no pixel of the rectified pair lacks an image).
  /// @param size  of the raw images
  /// @throws InputError when the calibration is for another size, or the right camera is not to the right
  Rectifier(const StereoCalibration& calibration, cv::Size size);

  /// The rectified pair. T_body_left is not known here and keeps its default.
  const StereoRig& rig() const { return rig_; }
  /// The rectified left camera in the raw one: a turn about the same centre.
  const Pose& T_raw_left() const { return T_raw_left_; }

  /// @param raw_left, raw_right  CV_8UC1 of the given size
  void rectify(const cv::Mat& raw_left, const cv::Mat& raw_right, cv::Mat& left, cv::Mat& right) const;
  /// Fills the frame's images and notes the time it took.
  void rectify(const cv::Mat& raw_left, const cv::Mat& raw_right, StereoFrame& frame) const;

 private:
  cv::Size size_;
  StereoRig rig_;
  Pose T_raw_left_ = Pose::Identity();
  std::array<cv::Mat, 2> left_map_, right_map_;  ///< of cv::remap: whole pixels, fractions
};

}  // namespace groundloop::slam
