#pragma once

#include <vector>

#include "bench/metrics/metrics.h"
#include "slam/types/frame_result.h"

namespace groundloop::bench {

/// timing.slam_ms_median, slam_ms_p99, keyframe_ms_median, wall_s, realtime_factor (time of the sequence by
/// wall time), render_ms (median of a pair; left out when nothing was rendered) and peak_memory_mb.
Metrics timing_metrics(const std::vector<slam::FrameResult>& frames, const std::vector<double>& render_ms,
                       double wall_s);

}  // namespace groundloop::bench
