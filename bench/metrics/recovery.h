#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bench/metrics/metrics.h"
#include "slam/types/frame_result.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// A key frame as the map holds it now, and where its camera truly was.
struct MappedView {
  int64_t frame = 0;
  slam::Pose T_map_left = slam::Pose::Identity();
  slam::Pose T_world_left = slam::Pose::Identity();
};

/// One frame as the bench sees it.
struct JudgedFrame {
  const slam::FrameResult& result;
  std::optional<slam::Pose> T_previous_left;  ///< planned motion since the frame before
  slam::Pose T_world_left;                    ///< true
};

/// Follows a run frame by frame: when was it interrupted, when was it right again, did it ever jump in
/// silence.
///
/// An interruption begins where tracking is lost, or where the camera truly moved otherwise than planned by
/// more than 0.1 m or 5 deg in one frame (it was carried away), and ends with the first frame that is not
/// lost and whose pose is right in the map as it was before: within 0.1 m and 2 deg of where the nearest key
/// frame from before puts it: the same frame, when it is followed at once. Being carried away again begins it
/// anew.
///
/// A silent jump is a step of the estimate that differs from the true step by more than 0.1 m or 5 deg, at a
/// frame that says nothing of it: it tracks as the frame before did, in the same segment, without a loop
/// link, and was not carried away.
class RecoveryJudge {
 public:
  /// Takes the frames in order.
  /// @param map  gives the key frames of now; called during interruptions only
  void observe(const JudgedFrame& frame, const std::function<std::vector<MappedView>()>& map);

  /// tracking.{interruptions, relocalised_s, silent_jumps}. Time from the beginning of an interruption to its
  /// end, of the longest; absent without interruptions, and when one did not end. No frames: empty.
  Metrics metrics() const;

 private:
  struct Interruption {
    int64_t frame = 0;
    int64_t stamp_ns = 0;
  };
  struct Before {
    slam::TrackingStatus status;
    int segment;
    slam::Pose T_map_left;
    slam::Pose T_world_left;
  };
  bool right_in_map(const JudgedFrame& frame, const std::vector<MappedView>& map) const;

  std::optional<Before> before_;
  std::optional<Interruption> open_;
  int interruptions_ = 0;
  int silent_jumps_ = 0;
  double longest_s_ = 0;
};

}  // namespace groundloop::bench
