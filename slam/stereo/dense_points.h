#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/stereo/disparity.h"
#include "slam/stereo/right_lag.h"
#include "slam/types/config.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Points of the dense disparity map that join the features' in the occupancy map. YAML: slam.dense_map
struct DenseMapOptions {
  int step_px = 6;                 ///< distance of the points in the image; 0: features only, as in the paper
  double weight = 1;               ///< trust in one such point, between 0 and 1
  double max_sigma_px = 0.15;      ///< points whose texture does not fix the disparity as well are left out
  double max_correction_px = 1.5;  ///< farther from the rough disparity is another surface
  double max_misfit = 1.6;         ///< of the two images' windows, relative to what is usual in the pair

  template <class Archive>
  void visit(Archive& a) {
    a("step_px", step_px, {.min = 0, .max = 1000});
    a("weight", weight, {.min = 0, .max = 1});
    a("max_sigma_px", max_sigma_px, {.min = 0.001, .max = 10});
    a("max_correction_px", max_correction_px, {.min = 0.1, .max = 10});
    a("max_misfit", max_misfit, {.min = 1, .max = 100});
  }
};

/// One point of the dense disparity, measured in the full-resolution images.
struct DensePoint {
  Eigen::Vector3f uvu_px = Eigen::Vector3f::Zero();  ///< (u_left, v, u_right)
  float sigma_px = 0;                                ///< standard deviation of u_left - u_right
};

/// Refines points of the rough disparity map by Gauss-Newton on windows of 16 x 12 px, the brightness of the
/// two images being free to differ by an offset.
///
/// The window's disparity is the mean over its texture, weighted by the squared horizontal gradient g. It is
/// therefore said of the centroid of g^2, not of the window's middle: on any plane, however slanted, that is
/// where it is exact, and where a plain wall lies beside the edge of something nearer, whose disparity is all
/// that the window knows, the point moves to that edge instead of thickening it.
///
/// The noise of a pixel is taken from what the two windows disagree by, and gives each point its standard
/// deviation, beside a tenth of a pixel that no texture takes away; the part of g^2 that is noise itself is
/// subtracted before.
///
/// Of a late right image, the surroundings of each point are drawn as they would have been in time at its
/// rough depth; there it is measured.
class DensePoints {
 public:
  DensePoints(const StereoRig& rig, const DenseMapOptions& options);

  /// @param left,right  the pair that `rough` was computed from, CV_8UC1
  /// @param rough       half-resolution map, see DenseDisparity::half_resolution()
  /// @param lag         of the right image
  /// Successive calls take turns with the points of different grids, so that a surface seen again is measured
  /// at other places than before.
  /// @return points, row by row; valid until the next call
  const std::vector<DensePoint>& measure(const cv::Mat& left, const cv::Mat& right, const cv::Mat& rough,
                                         const RightLag& lag = {});

 private:
  void forget_misfits();

  StereoRig rig_;
  DenseMapOptions options_;
  int64_t turn_ = 0;
  std::vector<Eigen::Vector3f> rough_uvu_px_;
  std::vector<DensePoint> points_;
  std::vector<float> misfit_grey_, sorted_misfit_grey_;
  cv::Mat around_;  ///< one point, as it would have been in time
};

}  // namespace groundloop::slam
