#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace groundloop::slam {

/// The smaller eigenvalue of the gradient matrix of every pixel (Shi and Tomasi, CVPR 1994): gradients by the
/// 3 x 3 Sobel operator, summed over a window of 5 x 5 px, in units of cv::cornerMinEigenVal. Sums are whole
/// numbers that roll along the columns, so that a pixel costs the same for any window; the image is read once.
class CornerResponse {
 public:
  static constexpr int kReach_px = 3;  ///< of window and gradient: nearer to the border the response is 0

  /// @param grey  CV_8UC1
  /// @return CV_32FC1, of the image's size; valid until the next call
  const cv::Mat& compute(const cv::Mat& grey);

 private:
  /// Gradients of one row of the image.
  struct Gradients {
    std::vector<int16_t> x, y;
  };
  cv::Mat response_;
  std::vector<Gradients> rows_;  ///< of the window, in a ring
  Gradients leaving_;            ///< its oldest row, that the newest takes the place of
  std::vector<int32_t> xx_, xy_, yy_;
};

}  // namespace groundloop::slam
