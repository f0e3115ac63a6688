#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "slam/types/pose.h"

namespace groundloop::slam {

/// One synchronous stereo pair, as a head, a recorded sequence or the simulator delivers it.
struct StereoFrame {
  int64_t index = 0;     ///< counts from 0, without gaps
  int64_t stamp_ns = 0;  ///< time of exposure, strictly increasing
  cv::Mat left;          ///< rectified, CV_8UC1
  cv::Mat right;         ///< rectified, CV_8UC1, same size

  /// Planned motion since the previous frame: pose of this left camera in the previous left camera, from the
  /// plan or from odometry, never from the truth. None: the core assumes constant velocity.
  std::optional<Pose> T_previous_left;

  double rectification_ms = 0;  ///< time it took to make the pair of raw images; 0: it came rectified
};

}  // namespace groundloop::slam
