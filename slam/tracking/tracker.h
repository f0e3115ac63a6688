#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "slam/features/affine_klt.h"
#include "slam/stereo/matcher.h"
#include "slam/tracking/feature.h"
#include "slam/types/config.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

class RightLag;

/// Options of tracking. YAML: slam.tracking
struct TrackingOptions {
  int max_features = 460;       ///< aimed at after every key frame in 640 x 480 px, more in a larger image
  int start_level = 1;          ///< coarsest pyramid level searched first; all levels are tried when it fails
  int planned_start_level = 0;  ///< the same where the robot told its motion
  double hold_lost_s = 0.45;    ///< time without a pose that is waited for before a new segment is started

  /// Known perspective of a window, from its first view and the surface there, is taken off its position.
  bool perspective = true;
  /// A match counts by its own precision, told by its residual and the texture of its window; or all alike.
  bool own_precision = true;
  double min_kept_ratio = 0.3;  ///< agreeing features, of those that should be in view; fewer: lost

  template <class Archive>
  void visit(Archive& a) {
    a("min_kept_ratio", min_kept_ratio, {.min = 0, .max = 1});
    a("perspective", perspective);
    a("own_precision", own_precision);
    a("max_features", max_features, {.min = 20, .max = 5000});
    a("start_level", start_level, {.min = 0, .max = 5});
    a("planned_start_level", planned_start_level, {.min = 0, .max = 5});
    a("hold_lost_s", hold_lost_s, {.min = 0, .max = 1000});
  }
};

/// Follows features through the left and the right images, from one stereo pair to the next.
class Tracker {
 public:
  Tracker(const StereoRig& rig, const TrackingOptions& options, const KltOptions& klt,
          const StereoMatcher& matcher);

  /// Finds every feature in a new pair. Where to look comes from the feature's 3D position and the motion, as
  /// section 2.3 of the paper says.
  /// @param T_kf_previous  pose of the previous left camera in the key frame's, as estimated
  /// @param T_kf_left      pose of the new one, as predicted
  /// @param planned        by the motion that the robot told, not by going on as before
  /// @param lag            of the right image, as known before
  void track(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_previous,
             const Pose& T_kf_left, bool planned, const RightLag& lag);

  /// Tries again the features that were not found, or did not agree, from their points alone.
  void track_again(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_previous,
                   const Pose& T_kf_left, const RightLag& lag);

  /// Takes another lag for the true one, off what was found with the one before.
  void take_off(const RightLag& lag, const Pose& T_kf_left);

  /// Adds a feature seen at uv_px in `left`, which becomes its first view; none when the window is no good.
  Feature* add(const ImagePyramid& left, const Eigen::Vector2f& uv_px);

  void clear();
  /// Removes the features for which `gone` is true; the order of the rest stays.
  template <class Predicate>
  void remove_if(Predicate gone) {
    size_t kept = 0;
    for (Feature& feature : features_) {
      if (gone(feature)) {
        free_slots_.push_back(feature.slot);
      } else {
        features_[kept++] = feature;
      }
    }
    features_.resize(kept);
  }

  std::vector<Feature>& features() { return features_; }
  const std::vector<Feature>& features() const { return features_; }
  const PatchTemplate& first_view(const Feature& feature) const { return *templates_[feature.slot]; }

 private:
  Eigen::Vector2f perspective_of(const Feature& feature, const Pose& T_left_kf,
                                 const Eigen::Vector3d& p_left) const;
  void track_one(const ImagePyramid& left, const ImagePyramid& right, const AffineState& start_left,
                 const AffineState& start_right, int start_level, Feature& feature) const;
  bool find(const PatchTemplate& patch, const ImagePyramid& image, const AffineState& start, int start_level,
            AffineState& state) const;

  StereoRig rig_;
  TrackingOptions options_;
  KltOptions klt_;
  StereoMatcher matcher_;
  std::vector<Feature> features_;
  std::vector<std::unique_ptr<PatchTemplate>> templates_;
  std::vector<int> free_slots_;
  int64_t next_id_ = 0;
};

}  // namespace groundloop::slam
