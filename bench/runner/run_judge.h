#pragma once

#include <optional>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/metrics/recovery.h"
#include "bench/metrics/truth/loop_truth.h"
#include "bench/metrics/truth/stage_judge.h"
#include "bench/runner/exact_map.h"
#include "bench/runner/simulated_source.h"
#include "slam/pipeline/pipeline.h"

namespace groundloop::bench {

/// What the comparison of a run with its truth found.
struct RunJudgement {
  Metrics metrics;
  slam::Trajectory truth;                ///< left camera in the world
  slam::Pose T_world_map;                ///< that lays the estimate on the truth
  std::vector<double> position_error_m;  ///< a frame, after alignment
  slam::Trajectory without_links;        ///< bench/metrics/correction.h; empty when no link entered
  std::vector<JudgedLink> links;
};

/// Compares a simulated run with its truth: some of it frame by frame, the rest at the end.
class RunJudge {
 public:
  /// All must outlive the judge.
  /// @param scene  is moved along with the frames
  RunJudge(SceneInTime& scene, const SimulatedSource& source, const slam::Pipeline& core);

  /// Takes the frames in order.
  /// @return the errors of the frame's stages
  StageErrors observe(const slam::StereoFrame& frame, const slam::FrameResult& result);

  /// After the last frame.
  RunJudgement judge(const std::vector<slam::FrameResult>& frames) const;

  const ExactMap& exact_map() const { return exact_.exact(); }

 private:
  slam::Pose T_world_seen(int64_t frame) const { return source_.truth(frame).T_world_seen; }
  Metrics map_metrics_at(const slam::Pose& T_world_map) const;
  LoopScore loops() const;
  Metrics uncertainty() const;
  std::vector<MappedView> mapped_views() const;

  SceneInTime& scene_;
  const SimulatedSource& source_;
  const slam::Pipeline& core_;
  Sight sight_;  ///< of what stands; at the end of the run, furniture where it stands then
  StageJudge stages_;
  ExactMapper exact_;
  RecoveryJudge recovery_;
};

}  // namespace groundloop::bench
