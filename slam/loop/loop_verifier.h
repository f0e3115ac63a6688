#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/features/affine_klt.h"
#include "slam/features/image_pyramid.h"
#include "slam/loop/descriptors.h"
#include "slam/loop/loop_options.h"
#include "slam/loop/stored_view.h"
#include "slam/registration/registration.h"
#include "slam/stereo/matcher.h"
#include "slam/stereo/right_lag.h"
#include "slam/types/loop_link.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// The pose of one left camera in another as trajectory and odometry have it.
struct PosePrediction {
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< right perturbation (translation, rotation) in `to`
};

/// The key frame that may have come back.
struct CurrentView {
  StoredView view;         ///< its left image, landmarks and described corners
  ImagePyramid left;       ///< of the same pair
  ImagePyramid right;      ///< of the same pair
  RightLag right_lag;      ///< of the right image
  cv::Mat half_disparity;  ///< DenseDisparity::half_resolution() of the same pair
};

/// What was found, or why there is no link.
struct Verification {
  bool accepted = false;
  std::string message = "not run";  ///< reason of refusal
  LoopLink link;                    ///< valid when accepted
  int expected = 0;                 ///< stored landmarks that should be seen
  double inlier_ratio = 0;          ///< of those, found where one motion puts them
  double reverse_ratio = 0;         ///< the same for the current landmarks in the stored image
};

/// Measures where the current key frame stands in a stored view, as precisely as odometry does, or says why
/// it does not stand there at all.
///
/// A coarse pose, predicted or from matched descriptors, tells where each stored landmark should be in the
/// current pair and in which shape; affine KLT of its first view finds it there; registration of the stored
/// points with what was found gives the pose. Then several tests that a false place fails in different ways.
class LoopVerifier {
 public:
  LoopVerifier(const StereoRig& rig, const LoopOptions& options, const KltOptions& klt,
               const StereoOptions& stereo, const RegistrationOptions& registration);

  /// @param prediction  none: nothing is known of where the current view is
  /// @param seed        of the samples of the coarse pose
  Verification verify(const StoredView& stored, const CurrentView& current,
                      const std::optional<PosePrediction>& prediction, uint64_t seed);

  /// Whether landmarks will be found from the predicted pose alone.
  bool precise_enough(const StoredView& stored, const PosePrediction& prediction) const;

 private:
  /// The stored landmarks found in the current pair.
  struct Search {
    std::vector<PointPair> pairs;
    int expected = 0;  ///< landmarks that the pose puts into both images, before everything seen there
  };

  /// A landmark and where another camera should see it.
  struct Visible {
    const Landmark* landmark;
    Eigen::Vector3d p_own;   ///< in the landmark's own left camera [m]
    Eigen::Vector3d uvu_px;  ///< in the other pair
    Eigen::Matrix2f A;       ///< d(uv in the other left image) / d(uv in its own)
  };

  void compare(const PosePrediction& prediction, bool was_away, const LoopOptions& needed,
               Verification& found) const;
  std::optional<Pose> coarse_pose(const StoredView& stored, const CurrentView& current, uint64_t seed,
                                  std::string& message);
  Verification refine(const StoredView& stored, const CurrentView& current, const Pose& T_from_to,
                      uint64_t seed, const LoopOptions& needed);
  void choose_visible(const std::vector<Landmark>& landmarks, const Pose& T_other_own, bool right_too,
                      int wanted, std::vector<Visible>& visible) const;
  void find_landmarks(const StoredView& stored, const CurrentView& current, const Pose& T_from_to,
                      Search& search);
  double reverse_ratio(const CurrentView& current, const Pose& T_from_to);
  std::string refusal(const StoredView& stored, const Verification& found, const LoopOptions& needed) const;
  bool find(const ImagePyramid& image, const Eigen::Vector2f& uv_px, const Eigen::Matrix2f& A,
            AffineState& state) const;
  int occupied_cells(const Search& search) const;

  StereoRig rig_;
  LoopOptions options_, eased_;
  KltOptions klt_;
  StereoMatcher matcher_;
  double sigma_px_;
  Registration coarse_, fine_;
  RegistrationResult registered_;
  PatchTemplate patch_;
  ImagePyramid stored_pyramid_;
  std::vector<DescriptorMatch> matches_;
  std::vector<PointPair> coarse_pairs_;
  std::vector<Visible> visible_;
  Search search_;
};

/// Distance of two statements about one pose, in standard deviations with the options' margins added.
double contradiction_sigma(const PosePrediction& a, const PosePrediction& b, const LoopOptions& options);

/// How the picture of a small surface that faces the first camera changes: d(uv in the second) / d(uv in the
/// first).
/// @param p_from  the surface, in the first left camera [m]
/// @param offset_m  of the second camera to the right: 0 for the left one, the baseline for the right one
Eigen::Matrix2d predicted_shape(const StereoRig& rig, const Pose& T_to_from, const Eigen::Vector3d& p_from,
                                double offset_m);

}  // namespace groundloop::slam
