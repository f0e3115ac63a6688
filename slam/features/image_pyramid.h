#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace groundloop::slam {

/// Smoothed images at full, half, quarter, ... resolution, as the tracker samples them.
///
/// Values are grey levels times kScale in 16 bits, so that smoothing loses nothing to rounding. Pixel (u, v)
/// of level 0 is (u, v) / 2^l of level l.
class ImagePyramid {
 public:
  static constexpr int kScale = 16;

  /// @param grey CV_8UC1; every level must keep at least 16 x 16 px
  void build(const cv::Mat& grey, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }
  const cv::Mat& level(int l) const { return levels_[l]; }  ///< CV_16SC1
  void swap(ImagePyramid& other) { levels_.swap(other.levels_); }

 private:
  std::vector<cv::Mat> levels_;
};

}  // namespace groundloop::slam
