#pragma once

#include <optional>

#include "slam/features/affine_klt.h"
#include "slam/stereo/disparity.h"
#include "slam/stereo/right_lag.h"
#include "slam/types/config.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Options of left-right matching. YAML: slam.stereo
struct StereoOptions {
  double epipolar_gate_px = 0.8;       ///< largest row difference of a match
  double min_disparity_px = 1.0;       ///< beyond the disparity at infinity; smaller ones carry no depth
  double max_prediction_error_px = 6;  ///< farther from the dense disparity is another surface
  double max_row_offset_px = 5;        ///< largest slip of the right image's rows that is taken back; 0: none
  double max_right_late_s = 0.1;       ///< largest lag of the right image that is taken back; 0: none

  template <class Archive>
  void visit(Archive& a) {
    a("epipolar_gate_px", epipolar_gate_px, {.min = 0.01, .max = 20});
    a("min_disparity_px", min_disparity_px, {.min = 0, .max = 100});
    a("max_prediction_error_px", max_prediction_error_px, {.min = 0.5, .max = 100});
    a("max_row_offset_px", max_row_offset_px, {.min = 0, .max = 100});
    a("max_right_late_s", max_right_late_s, {.min = 0, .max = 1});
  }
};

/// Left-right matching: the dense map predicts where a feature is in the right image, affine KLT of the
/// feature's first view finds it there. Section 2.2 of the paper.
class StereoMatcher {
 public:
  StereoMatcher(const StereoRig& rig, const StereoOptions& options, const KltOptions& klt)
      : rig_(rig), options_(options), klt_(klt) {}

  /// @param left  where the feature is in the left image
  /// @param dense  of a pair taken together
  /// @param lag    of the right image
  /// @return where it is in the right one, lag included, which plausible() has to check; none when the dense
  /// map knows
  ///         nothing of it, or something else
  std::optional<AffineState> match(const PatchTemplate& patch, const AffineState& left,
                                   const DenseDisparity& dense, const ImagePyramid& right,
                                   const RightLag& lag = {}) const;

  /// Whether two positions can be the same point: rows agree, disparity is positive.
  bool plausible(const Eigen::Vector2f& left_px, const Eigen::Vector2f& right_px) const;

 private:
  StereoRig rig_;
  StereoOptions options_;
  KltOptions klt_;
};

/// Measurement (u_left, v, u_right) of a matched pair. The point that minimises the image-plane error of a
/// rectified pair has the mean of the two rows and unchanged columns (Hartley and Sturm, CVIU 68(2), 1997).
Eigen::Vector3d optimal_measurement(const Eigen::Vector2f& left_px, const Eigen::Vector2f& right_px);

/// Covariance of an optimal_measurement() relative to the stated variance of one coordinate, by what the
/// matches of both images say of their own precision (AffineState::covariance_px2). Errors of the two images
/// are partly the same: what changed in a surface's looks since the first view, both see.
Eigen::Matrix3d match_cofactor(const Eigen::Matrix2f& left_px2, const Eigen::Matrix2f& right_px2);

}  // namespace groundloop::slam
