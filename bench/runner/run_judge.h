#pragma once

#include <optional>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/metrics/recovery.h"
#include "bench/metrics/truth/loop_truth.h"
#include "bench/metrics/truth/stage_judge.h"
#include "bench/runner/beside.h"
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
  std::vector<StageErrors> stages;       ///< a frame
  slam::Trajectory without_links;        ///< bench/metrics/correction.h; empty when no link entered
  std::vector<JudgedLink> links;
};

/// Compares a simulated run with its truth: some of it frame by frame, the rest at the end. What asks for
/// rays through the exact scene goes on in a thread of its own.
class RunJudge {
 public:
  /// All must outlive the judge.
  /// @param scene  is moved along with the frames
  RunJudge(SceneInTime& scene, const SimulatedSource& source, const slam::Pipeline& core);

  /// Takes the frames in order.
  void observe(const slam::StereoFrame& frame, const slam::FrameResult& result);

  /// After the last frame, once.
  RunJudgement judge(const std::vector<slam::FrameResult>& frames);

  /// Known once judged.
  const ExactMap& exact_map() const { return exact_.exact(); }

 private:
  /// A frame for the rays.
  struct Seen {
    slam::FrameResult result;
    double time_s;
    slam::Pose T_world_left;
    slam::Pose T_world_body;
  };
  void look(const Seen& seen);
  slam::Pose T_world_seen(int64_t frame) const { return source_.truth(frame).T_world_seen; }
  Metrics map_metrics(const slam::Pose& T_world_map, const slam::OccupancyMap& at_true_poses) const;
  LoopScore loops() const;
  Metrics uncertainty() const;
  Metrics drive() const;
  std::vector<MappedView> mapped_views() const;

  SceneInTime& scene_;
  const SimulatedSource& source_;
  const slam::Pipeline& core_;
  Sight sight_;  ///< of what stands; at the end of the run, furniture where it stands then
  StageJudge stages_;
  ExactMapper exact_;
  std::vector<StageErrors> stage_errors_;  ///< a frame
  int collisions_ = 0;                     ///< frames at which the robot touched something
  RecoveryJudge recovery_;
  Beside<Seen> looking_;  ///< last, so that it ends before what it uses, all above
};

}  // namespace groundloop::bench
