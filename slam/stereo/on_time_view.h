#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "slam/stereo/right_lag.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// How the right image of a late right camera is drawn as if it had been taken in time, and what is left
/// over.
///
/// A homography puts back what the turn of the camera has moved, at any distance, and what its way has moved
/// on one plane that faces the left camera. What stands before the plane or behind it is left beside its
/// place along the line from the late camera's centre, by so much that the two columns of a match still tell
/// its depth exactly.
class OnTimeView {
 public:
  /// @param lag      of the pair's right image
  /// @param depth_m  of the plane in the left camera, larger than what the camera moves meanwhile
  OnTimeView(const StereoRig& rig, const RightLag& lag, double depth_m);

  /// (u, v, 1) [px] of the view -> where the late right image shows it, homogeneous.
  const Eigen::Matrix3d& late_of_view() const { return late_of_view_; }

  /// Draws as much of the view as `view` has room for.
  /// @param late   right image as it was taken, CV_8UC1
  /// @param first  pixel of the view that becomes the first one of `view`
  /// @param view   CV_8UC1
  /// @return whether the late image shows all of it
  bool draw(const cv::Mat& late, const Eigen::Vector2i& first, cv::Mat& view) const;

  /// Disparity [px] in a pair taken together of what was matched between the left image and the view.
  /// Infinity has StereoRig::disparity_at_infinity_px(); what comes out below it is no point.
  /// @param u_left_px, u_view_px  columns of the match
  double disparity_px(double u_left_px, double u_view_px) const {
    // Along the late camera's axes turned back: x / z of the ray that has seen the point.
    const double ray = (u_view_px - u_view_zero_px_) * ray_per_px_;
    const double left_ray = (u_left_px - cx_px_) / fx_px_;
    return at_infinity_px_ + depth_factor_px_m_ * (left_ray - ray) / (centre_x_m_ - ray * centre_z_m_);
  }

 private:
  Eigen::Matrix3d late_of_view_;
  double fx_px_, cx_px_;
  double at_infinity_px_;
  double depth_factor_px_m_;        ///< fx baseline
  double centre_x_m_, centre_z_m_;  ///< of the late right camera in the left one
  double u_view_zero_px_;           ///< column of the view whose rays have no x
  double ray_per_px_;
};

}  // namespace groundloop::slam
