#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// A 3D point of a key frame, defined as what its left image shows at uv_px: only its depth is uncertain.
struct Landmark {
  Eigen::Vector2f uv_px;  ///< in the left image
  float depth_m = 0;      ///< z in that left camera
  float sigma_m = 0;      ///< standard deviation of depth_m
};

inline Eigen::Vector3d point_of(const StereoRig& rig, const Landmark& landmark) {
  return landmark.depth_m * Eigen::Vector3d((landmark.uv_px.x() - rig.cx_px) / rig.fx_px,
                                            (landmark.uv_px.y() - rig.cy_px) / rig.fy_px, 1);
}

/// 256 bits of binary comparisons (ORB: Rublee et al., ICCV 2011).
using Descriptor = std::array<uint64_t, 4>;

/// A described corner with a rough depth.
struct Keypoint {
  Eigen::Vector3f uvu_px = Eigen::Vector3f::Zero();  ///< (u_left, v, u_right)
  Descriptor descriptor{};
};

/// What is kept of a key frame so that its place is known again: its left image, from which the first views
/// of its landmarks are taken again, and its described corners. A 640 x 480 image with 400 landmarks and 400
/// corners takes 307 + 6 + 18 kB.
struct StoredView {
  int64_t index = 0;  ///< of the frame
  cv::Mat grey;       ///< left image, CV_8UC1
  std::vector<Landmark> landmarks;
  std::vector<Keypoint> keypoints;
  bool was_away = false;  ///< whether the camera has looked at something else since

  size_t bytes() const {
    return grey.total() + landmarks.size() * sizeof(Landmark) + keypoints.size() * sizeof(Keypoint);
  }
};

}  // namespace groundloop::slam
