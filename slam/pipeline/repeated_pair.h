#pragma once

#include <opencv2/core/mat.hpp>

#include "slam/types/stereo_frame.h"

namespace groundloop::slam {

/// Knows a pair that is, byte for byte, the pair before again, as a frame grabber hands out that has nothing
/// newer: noise makes two exposures of one scene differ. Where the plan has the camera stand still, two
/// noise-free images of it are the same by right, and without a plan nobody knows: neither is a repetition.
class RepeatedPair {
 public:
  /// Whether the images are those of the last call; keeps a copy of those that are not.
  bool is(const StereoFrame& frame);

 private:
  cv::Mat left_, right_;
};

}  // namespace groundloop::slam
