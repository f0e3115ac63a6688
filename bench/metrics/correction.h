#pragma once

#include <vector>

#include "bench/metrics/metrics.h"
#include "slam/types/frame_result.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// The trajectory as it would have been without loop closing: the motions from frame to frame as they were
/// known at each, one after the other; empty when no link entered. Across a frame at which links entered,
/// where the pose as known jumps, the motion is that of the final trajectory.
/// @param final_T_map_left  of the same frames
slam::Trajectory without_links(const std::vector<slam::FrameResult>& frames,
                               const slam::Trajectory& final_T_map_left);

/// loop.ate_before_m (of the trajectory without links) and loop.ate_after_m (of the final one), both aligned
/// by SE(3); absent when no link entered.
Metrics correction_metrics(const slam::Trajectory& T_world_left, const slam::Trajectory& without_links,
                           const slam::Trajectory& final_T_map_left);

}  // namespace groundloop::bench
