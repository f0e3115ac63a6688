#pragma once

#include <functional>
#include <set>

#include "bench/metrics/truth/sight.h"
#include "slam/types/oracle.h"

namespace groundloop::bench {

/// True pose of the left camera of a frame that was delivered; may be called by several threads.
using TruePoses = std::function<slam::Pose(int64_t frame)>;

/// Answers the core's questions from the exact scene. It stands still: people are not seen, moved furniture
/// stays where it was.
class TruthOracle : public slam::Oracle {
 public:
  /// @param stages  to be replaced
  /// @param scene   must outlive the oracle
  TruthOracle(std::set<slam::OracleStage> stages, const sim::TruthWorld& scene, const slam::StereoRig& rig,
              TruePoses T_world_left);

  bool replaces(slam::OracleStage stage) const override { return stages_.contains(stage); }
  std::optional<slam::TrueMatch> track(int64_t first, const Eigen::Vector2d& uv_first_px,
                                       int64_t frame) const override;
  std::optional<double> disparity_px(int64_t frame, const Eigen::Vector2d& uv_left_px) const override;
  std::optional<slam::Pose> T_from_to(int64_t from, int64_t to) const override;
  /// Same place: bench/metrics/truth/loop_truth.h.
  std::optional<slam::Pose> loop_T_from_to(int64_t from, int64_t to) const override;

 private:
  std::set<slam::OracleStage> stages_;
  Sight sight_;
  TruePoses T_world_left_;
};

}  // namespace groundloop::bench
