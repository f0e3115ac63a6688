#include <benchmark/benchmark.h>

#include "slam/adjustment/window_adjustment.h"
#include "tests/slam/adjustment/ceres_window.h"
#include "tests/slam/adjustment/synthetic_window.h"

namespace groundloop::slam {
namespace {

/// 8 key frames, 400 landmarks, about 2000 observations, a tenth of them false; three iterations.
struct Fixture {
  StereoRig rig = pioneer_rig();
  AdjustmentOptions options;
  SyntheticWindow window;

  Fixture() {
    options.max_iterations = 3;
    window = make_window(rig, {.landmarks = 400, .outliers = 0.1});
  }
  void describe(benchmark::State& state, const AdjustmentResult& result) const {
    state.counters["observations"] = static_cast<double>(window.problem.observations.size());
    state.counters["iterations"] = result.iterations;
    state.counters["cost"] = result.cost_after;
  }
};

void adjust_8_key_frames(benchmark::State& state) {
  const Fixture f;
  WindowAdjustment adjustment(f.rig, f.options);
  AdjustmentResult result;
  for (auto _ : state) adjustment.solve(f.window.problem, result);
  if (!result.usable) state.SkipWithError(result.message.c_str());
  f.describe(state, result);
}
BENCHMARK(adjust_8_key_frames)->Unit(benchmark::kMillisecond);

void adjust_8_key_frames_by_ceres(benchmark::State& state) {
  const Fixture f;
  AdjustmentResult result;
  for (auto _ : state) result = ceres_window(f.rig, f.options, f.window.problem, 0);
  if (!result.usable) state.SkipWithError(result.message.c_str());
  f.describe(state, result);
}
BENCHMARK(adjust_8_key_frames_by_ceres)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
