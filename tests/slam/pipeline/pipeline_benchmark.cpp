#include <benchmark/benchmark.h>

#include "slam/pipeline/pipeline.h"
#include "tests/slam/pipeline/box_room.h"

namespace groundloop::slam {
namespace {

/// A core at 640 x 480 and the first three pairs of a drive.
struct Drive {
  explicit Drive(const std::string& preset_name, int interval_frames) : options(preset(preset_name)) {
    options.key_frame = {10, 180, 0, interval_frames};
    for (int64_t i = 0; i < 3; ++i) frames.push_back(room.frame(i));
  }

  /// Times a robot that goes to and fro between the second and the third pair.
  void run(benchmark::State& state, bool key_frames) {
    Pipeline core(room.rig(), options);
    core.process(frames[0]);
    core.process(frames[1]);
    int64_t index = 2;
    double tracked = 0;
    for (auto _ : state) {
      const int64_t step = 1 + (index + 1) % 2;  // 2, 1, 2, 1, ...
      StereoFrame frame = frames[static_cast<size_t>(step)];
      frame.index = index++;
      frame.T_previous_left = room.T_map_left(static_cast<double>(3 - step)).inverse() *
                              room.T_map_left(static_cast<double>(step));
      const FrameResult result = core.process(frame);
      if (result.status != TrackingStatus::kTracking) state.SkipWithError(result.message.c_str());
      if (result.is_key_frame != key_frames) state.SkipWithError("not the frame that was wanted");
      tracked += result.features_tracked;
    }
    state.counters["features"] = benchmark::Counter(tracked, benchmark::Counter::kAvgIterations);
  }

  const BoxRoom room{2};
  SlamOptions options;
  std::vector<StereoFrame> frames;
};

void ordinary_frame_640x480(benchmark::State& state, const std::string& preset_name) {
  Drive(preset_name, 100000).run(state, false);
}
void key_frame_640x480(benchmark::State& state, const std::string& preset_name) {
  Drive(preset_name, 1).run(state, true);
}
BENCHMARK_CAPTURE(ordinary_frame_640x480, paper, "paper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ordinary_frame_640x480, default, "default")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(key_frame_640x480, paper, "paper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(key_frame_640x480, default, "default")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
