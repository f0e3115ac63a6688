#pragma once

#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <vector>

namespace groundloop::slam {

/// Rotations and projections that a calibration chose for its rectified pair, in OpenCV's terms.
struct ChosenRectification {
  cv::Matx33d R1, R2;  ///< raw -> rectified camera
  cv::Matx34d P1, P2;  ///< projections of the rectified pair; P2(0, 3) = -fx baseline
};

/// A stereo calibration as OpenCV's stereo_calib sample writes it. Lengths in the unit of the board's squares
/// when it was made: metres, here.
struct StereoCalibration {
  std::string file;              ///< for messages
  std::optional<cv::Size> size;  ///< image_width, image_height, when the file says
  cv::Matx33d M1, M2;            ///< camera matrices [px] of left and right
  std::vector<double> D1, D2;    ///< distortion: k1, k2, p1, p2 (, k3 (, k4, k5, k6))
  cv::Matx33d R;                 ///< x_right = R x_left + T
  cv::Vec3d T;
  std::optional<ChosenRectification> chosen;  ///< when the file has R1, R2, P1, P2
};

/// Reads the calibration from one file, or from two that share the keys (OpenCV's intrinsics.yml and
/// extrinsics.yml). Wanted are M1, D1, M2, D2 and either R and T, or R1, R2, P1 and P2. Other keys are passed
/// over.
/// @throws InputError naming file, line, key, value and what was wanted, all problems at once
StereoCalibration read_stereo_calibration(const std::vector<std::string>& files);

/// The same from a file's text.
/// @param name  stands for the file in messages
StereoCalibration parse_stereo_calibration(const std::string& text, const std::string& name);

}  // namespace groundloop::slam
