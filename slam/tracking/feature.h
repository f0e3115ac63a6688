#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "slam/features/affine_klt.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {

/// A feature while it lives: its first view (in the tracker's template store), where it is now in both
/// images, and its reconstruction at the last key frame.
struct Feature {
  int64_t id = 0;
  int slot = 0;  ///< of its first view

  int64_t first_frame = 0;  ///< of its first view
  Eigen::Vector2f first_uv_px = Eigen::Vector2f::Zero();

  Pose T_kf_first = Pose::Identity();  ///< left camera of its first view in that of the last key frame
  Eigen::Vector2f slope_per_px =
      Eigen::Vector2f::Zero();  ///< of the surface there, see inverse_depth_slope()

  AffineState left;
  AffineState right;                                  ///< as if taken together with the left
  Eigen::Vector2f late_px = Eigen::Vector2f::Zero();  ///< what a lag of the right image moved it by there
  Eigen::Matrix2f shape_before = Eigen::Matrix2f::Identity();  ///< shape in the previous left image
  bool in_left = false;                                        ///< found in the current left image
  bool found_right = false;                                    ///< found in the current right image
  bool in_right = false;                                       ///< found there, and left-right plausible

  Eigen::Matrix3d cofactor = equal_cofactor();  ///< of the measurement, see match_cofactor()

  Eigen::Vector3d p_kf = Eigen::Vector3d::Zero();  ///< in the left camera of the last key frame [m]
  Eigen::Matrix3d covariance_kf = Eigen::Matrix3d::Identity();
  bool is_inlier = false;  ///< agreed with the last registered motion
  int key_frames = 0;      ///< number of key frames that reconstructed it
};

}  // namespace groundloop::slam
