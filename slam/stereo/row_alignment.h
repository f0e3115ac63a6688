#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "slam/stereo/matcher.h"

namespace groundloop::slam {

/// Finds that the right image has slipped against its calibration, as when its camera was knocked, by the
/// rows on which left-right matches really lie, and moves it back. While matches lie on their rows the images
/// pass through untouched.
///
/// Tilt shows in the rows, to be measured by every match. Pan does not: a pair alone cannot tell it from
/// other distances. Roll, which moves each column otherwise, is not corrected.
class RowAlignment {
 public:
  explicit RowAlignment(const StereoOptions& options) : options_(options) {}

  /// The right image with its rows where they belong: itself, or else a buffer that the next call reuses.
  cv::Mat aligned(const cv::Mat& right);

  /// Takes the row differences, right minus left [px], of one aligned pair's matches before any check of
  /// rows, and reorders them. Three pairs one after the other whose matches are off alike make a slip.
  /// @return what most matches are off by alike; none when rows are right, or matches too few or at odds
  std::optional<double> observe(std::vector<float>& differences_px);

  /// By how much the right image is taken to have slipped down [px].
  double offset_px() const { return offset_px_; }

 private:
  StereoOptions options_;
  double offset_px_ = 0;
  std::vector<double> seen_px_;  ///< of the newest pairs that were off alike, at most three
  cv::Mat aligned_;
};

}  // namespace groundloop::slam
