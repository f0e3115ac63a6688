#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "slam/stereo/matcher.h"

namespace groundloop::slam {

/// One match of a pair, as it tells of a lag.
struct LagSight {
  Eigen::Vector2d at =
      Eigen::Vector2d::Zero();   ///< direction in the left image: (u - cx) / fx, (v - cy) / fy
  double row_difference_px = 0;  ///< right minus left, the lag as known taken off
  double row_flow_px_per_s = 0;  ///< RightLag::row_flow_px_per_s()
};

/// Finds that the right camera exposes late, by the rows of left-right matches while the head moves: the flow
/// has carried each match off its row by its own speed times the lag. What a calibration is off by moves rows
/// by their place in the image, whatever the motion; that much is fitted beside it and left alone.
///
/// Columns say nothing: a pair alone cannot tell flow along them from other distances. Nor can a pair tell a
/// camera that was knocked aside from a late one while the head turns on the spot. But a turned camera stays
/// so: how it is turned is carried on from pair to pair, learnt wherever a pair can tell.
class LagEstimate {
 public:
  explicit LagEstimate(const StereoOptions& options) : options_(options) {}

  /// Whether a lag is looked for at all; if not, nothing need be observed.
  bool wanted() const { return options_.max_right_late_s > 0; }

  /// Takes the matches of one pair. Where too little flows, nothing is learnt and nothing forgotten.
  void observe(const std::vector<LagSight>& sights);

  /// Right exposure after the left one [s], as far as it is known not to be none; else 0.
  double late_s() const { return claimed_ ? late_s_ : 0; }

 private:
  /// What one pair says.
  struct OfPair {
    double late_s;
    double noise_s2;        ///< variance from noise of the matches, another one in each pair
    double calibration_s2;  ///< from errors that matches share, and pairs too
    Eigen::Vector2d turned_px;
  };
  std::optional<OfPair> fit(const std::vector<LagSight>& sights) const;
  void take(const OfPair& pair);

  StereoOptions options_;
  double late_s_ = 0;
  double noise_s2_ = 1;  ///< variance of late_s_, as OfPair has it
  double calibration_s2_ = 0;
  /// By what the right camera is turned (aside, up) [px in the image's middle]: rows are off by that times
  /// (x y, y y).
  Eigen::Vector2d turned_px_ = Eigen::Vector2d::Zero();
  bool claimed_ = false;
};

}  // namespace groundloop::slam
