#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/runner/options.h"
#include "slam/pipeline/pipeline.h"
#include "slam/source/stereo_source.h"

namespace groundloop::bench {

/// What a run of the core over a source left behind, beside the core's own map and trajectory.
struct CoreRun {
  std::vector<slam::FrameResult> frames;  ///< without their features
};

/// Called with every pair and what the core said of it.
using FrameObserver = std::function<void(const slam::StereoFrame&, const slam::FrameResult&)>;

/// Feeds a source to the core until it ends or `frames` pairs are done. The source runs
/// ahead in a thread of its own; core and observers run here.
/// @param release  makes a source that waits for results of the core return
/// @throws Interrupted when the job is stopped
CoreRun run_core(slam::StereoSource& source, slam::Pipeline& core, const std::string& name,
                 std::optional<int64_t> frames, const FrameObserver& observe, const JobControl& control,
                 const std::function<void()>& release = {});

/// Thrown when a job was stopped before its end (Ctrl-C).
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("stopped before the end; nothing was written") {}
};

}  // namespace groundloop::bench
