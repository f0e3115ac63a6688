#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "slam/features/image_pyramid.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Rotation of the camera between two frames from the whole image, small and blurred: a start for the tracker
/// when the planned motion is missing or wrong. Parallax is ignored, so the result is rough.
///
/// Gauss-Newton over the three angles on sum (J(K R K^-1 x) - I(x))^2 with mean-free images (the idea of
/// PTAM's small blurry image, Klein & Murray, ECCV 2008).
class RotationAlignment {
 public:
  explicit RotationAlignment(const StereoRig& rig) : rig_(rig) {}

  /// Keeps the coarsest level of the left image for the next call to align().
  void remember(const ImagePyramid& left);

  /// @param predicted_R_previous_left  where to start
  /// @return R_previous_left: takes directions from the current left camera to the remembered one
  Eigen::Matrix3d align(const ImagePyramid& left, const Eigen::Matrix3d& predicted_R_previous_left);

 private:
  void shrink(const ImagePyramid& pyramid, cv::Mat& small) const;

  StereoRig rig_;
  cv::Mat previous_, current_, gradient_x_, gradient_y_;
};

}  // namespace groundloop::slam
