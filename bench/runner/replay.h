#pragma once

#include "bench/runner/options.h"
#include "bench/runner/run.h"

namespace groundloop::bench {

/// `groundloop replay`: the same core on a recorded sequence, judged when it holds a truth (poses.txt in
/// KITTI's layout, gt.tum, gt_point.tum, EuRoC's state_groundtruth_estimate0, or the file named).
/// @throws InputError, Interrupted
RunOutcome replay(const ReplayOptions& options, const JobControl& control);

}  // namespace groundloop::bench
