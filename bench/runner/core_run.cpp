#include "bench/runner/core_run.h"

#include "bench/runner/ahead.h"

namespace groundloop::bench {

CoreRun run_core(slam::StereoSource& source, slam::Pipeline& core, const std::string& name,
                 std::optional<int64_t> frames, const FrameObserver& observe, const JobControl& control,
                 const std::function<void()>& release) {
  CoreRun run;
  const int64_t total = std::min(frames.value_or(INT64_MAX), source.size().value_or(INT64_MAX));
  Ahead<slam::StereoFrame> ahead([&source] { return source.next(); }, 4, release);
  for (int64_t done = 0; done < total; ++done) {
    if (control.stop != nullptr && control.stop->load()) throw Interrupted();
    const std::optional<slam::StereoFrame> frame = ahead.next();
    if (!frame) break;
    slam::FrameResult result = core.process(*frame);
    observe(*frame, result);
    std::vector<slam::FeatureObservation>().swap(result.features);  // clearing would keep the storage
    run.frames.push_back(std::move(result));
    if (control.progress) control.progress(name, done + 1, total == INT64_MAX ? 0 : total);
  }
  core.finish();
  return run;
}

}  // namespace groundloop::bench
