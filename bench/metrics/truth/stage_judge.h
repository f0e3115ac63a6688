#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "bench/metrics/metrics.h"
#include "sim/truth/truth_world.h"
#include "slam/types/frame_result.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::bench {

/// Errors farther than this from the truth are outliers: counted, and kept out of the rmse (as KITTI counts
/// them).
inline constexpr double kOutlier_px = 3;

/// Squared errors of one kind: what the rmse and the outlier fraction are made of.
struct ErrorSum {
  int64_t inliers = 0;
  int64_t outliers = 0;
  double squared = 0;  ///< over the inliers

  void add(double error, bool inlier);
  ErrorSum& operator+=(const ErrorSum& other);
  std::optional<double> rmse() const;              ///< none without inliers
  std::optional<double> outlier_fraction() const;  ///< none without errors
};

/// How far each stage of one frame, or of a whole run, was from the truth.
///
/// disparity  left minus right column of a matched feature, against the disparity of the true surface at its
/// left
///            pixel. A corner on an edge may belong to either side of it: where the error is an outlier, the
///            true surfaces one pixel left, right, above and below count too, and the best one is taken.
/// track      feature against the projection, with true poses, of the true surface point under its first
/// view.
///            The first view itself is not counted.
/// point      triangulated point against the true surface point under the same pixel, in metres; features
/// whose
///            disparity is no outlier.
/// registration  motion from key frame to key frame against the true one: length of the translation of
///            T_truth^-1 T_estimate [m] and its rotation angle [deg]. Not across a loss of track.
struct StageErrors {
  ErrorSum disparity_px;
  ErrorSum track_px;
  ErrorSum point_m;
  ErrorSum registration_trans_m;
  ErrorSum registration_rot_deg;

  StageErrors& operator+=(const StageErrors& other);
  /// stage.{disparity_rmse_px, stereo_outlier_fraction, track_rmse_px, track_outlier_fraction, point_rmse_m,
  /// registration_trans_m, registration_rot_deg}; absent where nothing was measured
  Metrics metrics() const;
};

/// Judges the stages of one run frame by frame. Where something moves (sim::TruthWorld::move_to), the truth
/// must be as it was seen in the frame that is judged; a surface point moves with its geom.
class StageJudge {
 public:
  /// @param truth  must outlive the judge
  StageJudge(const sim::TruthWorld& truth, const slam::StereoRig& rig);

  /// Takes the frames of a run in order and gives each one's errors.
  /// @param T_world_left  true pose of the left camera at this frame
  StageErrors judge(const slam::FrameResult& frame, const slam::Pose& T_world_left);

  /// Errors of all frames so far.
  const StageErrors& total() const { return total_; }

 private:
  /// Where a pixel's ray meets the scene.
  struct Surface {
    double depth_m = 0;
    int geom = -1;
  };
  std::optional<Surface> surface(const slam::Pose& T_world_left, double u_px, double v_px) const;
  /// The true surface under a feature, none where there is none.
  std::optional<Surface> true_surface(const slam::FeatureObservation& feature,
                                      const slam::Pose& T_world_left) const;
  void judge_stereo(const slam::FeatureObservation& feature, double true_depth_m, StageErrors& errors) const;
  void judge_registration(const slam::FrameResult& frame, const slam::Pose& T_world_left,
                          StageErrors& errors);

  struct KeyFrame {
    int segment;
    slam::Pose T_map_left;
    slam::Pose T_world_left;
  };
  /// A surface point, and the geom that it belongs to.
  struct FirstView {
    int geom;
    Eigen::Vector3d p_geom;
  };
  const sim::TruthWorld& truth_;
  slam::StereoRig rig_;
  std::map<int64_t, FirstView> first_views_;  ///< of the features now alive
  std::optional<KeyFrame> last_key_frame_;
  StageErrors total_;
};

}  // namespace groundloop::bench
