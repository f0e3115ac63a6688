#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "slam/features/detector.h"
#include "slam/pipeline/options.h"
#include "slam/pipeline/stage_clock.h"
#include "slam/registration/registration.h"
#include "slam/stereo/disparity.h"
#include "slam/stereo/lag_estimate.h"
#include "slam/stereo/matcher.h"
#include "slam/stereo/right_lag.h"
#include "slam/stereo/row_alignment.h"
#include "slam/tracking/rotation_alignment.h"
#include "slam/tracking/tracker.h"
#include "slam/types/frame_result.h"
#include "slam/types/oracle.h"
#include "slam/types/stereo_frame.h"

namespace groundloop::slam {

/// The frame path's work on images: features and their reconstruction at key frames, their tracking and
/// registration in between. It knows poses only within the current key frame. Sections 2.1 to 2.3 of the
/// paper.
class FrontEnd {
 public:
  /// @param oracle  answers in the place of a stage, in experiments; may be null, must outlive this
  FrontEnd(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle);

  /// The frame with the right image's rows where they belong.
  StereoFrame rows_aligned(const StereoFrame& frame);
  /// Takes the images of a new frame, rows aligned.
  void see(const StereoFrame& frame, StageClock& clock);

  /// Tracks the features of the last key frame and registers their new reconstruction with the old one.
  /// @param T_kf_previous   pose of the previous frame in the last key frame
  /// @param T_kf_predicted  where the new one should be; overwritten by a better guess when it was far off
  const RegistrationResult& follow(const StereoFrame& frame, const Pose& T_kf_previous, Pose& T_kf_predicted,
                                   StageClock& clock);

  /// Makes the current frame the first key frame of a segment.
  void start(const StereoFrame& frame, StageClock& clock);
  /// Makes the current frame the next key frame: what agreed stays, new features join.
  /// @param T_kf_left    its pose in the last key frame
  /// @param reconstruct  true: every feature's point is triangulated anew; false: it is carried over
  void renew(const StereoFrame& frame, const Pose& T_kf_left, bool reconstruct, StageClock& clock);

  /// Learns from all matches of the current frame whether its rows are right.
  /// @return what most of them are off by alike [px]; none when there is nothing of the kind
  std::optional<double> check_rows() { return rows_.observe(row_differences_px_); }
  double row_offset_px() const { return rows_.offset_px(); }      ///< see RowAlignment
  double right_late_s() const { return lag_estimate_.late_s(); }  ///< see LagEstimate

  /// Features of the last key frame, with their points there.
  std::vector<Feature>& features() { return tracker_.features(); }
  const std::vector<Feature>& features() const { return tracker_.features(); }
  template <class Predicate>
  void remove_if(Predicate gone) {
    tracker_.remove_if(gone);
  }
  void forget_features() { tracker_.clear(); }

  const ImagePyramid& left() const { return left_; }
  const ImagePyramid& right() const { return right_; }
  /// Of the last key frame.
  const DenseDisparity& dense() const { return dense_; }
  /// Of the current frame's right image.
  const RightLag& right_lag() const { return lag_; }

  size_t key_frame_features() const { return kf_features_; }       ///< reconstructed at the last key frame
  double key_frame_depth_m() const { return kf_median_depth_m_; }  ///< median of theirs

 private:
  /// Takes what the matches say of their own precision for that of the measurement.
  void weigh(Feature& feature) const;
  bool replaced(OracleStage stage) const { return oracle_ != nullptr && oracle_->replaces(stage); }
  void look_up_tracks(int64_t frame);
  bool blown_out(const Eigen::Vector2d& uv_px) const;
  int expected_in_view(const Pose& T_kf_predicted) const;
  void distrust_few(int expected);
  void register_points(const StereoFrame& frame, const Pose& T_kf_predicted);
  void triangulate_again();
  void carry_over(const Pose& T_left_kf);
  void add_features(const StereoFrame& frame, StageClock& clock);
  void look_densely(const StereoFrame& frame);
  bool match(int64_t frame, Feature& feature);
  void note_row(const Feature& feature);
  RightLag lag_after(const Pose& T_previous_left) const;
  void check_lag(const Pose& T_kf_previous, const Pose& T_kf_left);
  void measure_key_frame();

  StereoRig rig_;
  SlamOptions options_;
  const Oracle* oracle_;
  Detector detector_;
  DenseDisparity dense_;
  StereoMatcher matcher_;
  RowAlignment rows_;
  LagEstimate lag_estimate_;
  Tracker tracker_;
  RotationAlignment rotation_;
  Registration registration_;

  ImagePyramid left_, right_;
  std::vector<PointPair> pairs_;
  std::vector<size_t> pair_feature_;  ///< index into features(), per pair
  RegistrationResult registered_;
  std::vector<float> row_differences_px_;  ///< of the current frame's matches
  std::vector<LagSight> lag_sights_;
  std::vector<Eigen::Vector2f> occupied_;
  std::vector<double> depths_m_;

  int64_t seen_ns_ = 0;                          ///< time of the current frame
  double elapsed_s_ = 0;                         ///< since the frame seen before
  Vector6d velocity_before_ = Vector6d::Zero();  ///< mean until the frame before [m/s, rad/s]
  double elapsed_before_s_ = 0;                  ///< that it is the mean of; 0: not known
  RightLag lag_;                                 ///< of the current frame
  int64_t kf_frame_ = 0;
  size_t kf_features_ = 0;
  double kf_median_depth_m_ = 0;
};

}  // namespace groundloop::slam
