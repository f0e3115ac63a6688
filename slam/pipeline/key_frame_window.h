#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "slam/adjustment/adjustment_problem.h"
#include "slam/tracking/feature.h"

namespace groundloop::slam {

/// What an adjustment is asked, with the names of its parts.
struct WindowProblem {
  AdjustmentProblem problem;
  std::vector<int> key_frames;       ///< number of each of the problem's key frames
  std::vector<int64_t> feature_ids;  ///< of each landmark, rising
};

/// The newest key frames of a segment, and where each of them saw its features.
class KeyFrameWindow {
 public:
  explicit KeyFrameWindow(const AdjustmentOptions& options) : options_(options) {}

  void clear() { key_frames_.clear(); }

  /// Takes in a key frame with the features it has just reconstructed; the oldest one leaves a full window.
  /// @param T_previous_planned  planned motion since the key frame before, none when there is no plan
  void add(int key_frame, const Pose& T_odom_left, const std::optional<Pose>& T_previous_planned,
           const std::vector<Feature>& features);

  /// The window as an adjustment problem, its oldest key frame anchored; the landmarks are the features that
  /// were seen from two key frames or more.
  WindowProblem problem(const GroundPlane& plane) const;

  /// Takes over the poses of key frames that are still in the window.
  void refine(const std::vector<int>& key_frames, const std::vector<Pose>& T_odom_left);

  size_t size() const { return key_frames_.size(); }

 private:
  struct Sight {
    int64_t feature_id;
    Eigen::Vector3d uvu_px;
    Eigen::Matrix3d cofactor;  ///< of uvu_px
    Eigen::Vector3d p_left;    ///< where the feature was then believed to be
  };
  struct KeyFrame {
    int number;
    Pose T_odom_left;
    std::optional<Pose> T_previous_planned;
    std::vector<Sight> sights;
  };

  AdjustmentOptions options_;
  std::deque<KeyFrame> key_frames_;  ///< oldest first
};

}  // namespace groundloop::slam
