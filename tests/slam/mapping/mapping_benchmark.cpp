#include <benchmark/benchmark.h>

#include "slam/mapping/grid_matcher.h"
#include "slam/mapping/local_map.h"
#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

/// One key frame of the laboratory lap into the local and then the global map; the number of points is the
/// argument.
void add_key_frame(benchmark::State& state, const FlogOptions& options) {
  const RoomWorld world = RoomWorld::laboratory();
  const StereoRig rig = laboratory_rig();
  const std::vector<Pose> lap = laboratory_lap(40);
  std::vector<std::vector<MapPoint>> points;
  for (size_t i = 0; i < lap.size(); ++i) {
    points.push_back(measure(world, rig, lap[i], static_cast<int>(state.range(0)), 0.25, i));
  }
  FlogGrid grid(options);
  LocalMap local(options, rig);
  size_t i = 0;
  for (auto _ : state) {
    local.add_key_frame(lap[i].translation(), points[i]);
    local.add_to(grid);
    i = (i + 1) % lap.size();
  }
}

void add_key_frame_to_layers(benchmark::State& state) { add_key_frame(state, FlogOptions{}); }
void add_key_frame_to_layers_and_band(benchmark::State& state) {
  FlogOptions options;
  options.fuse_layers = false;
  add_key_frame(state, options);
}
BENCHMARK(add_key_frame_to_layers)->Arg(500)->Arg(5000)->Unit(benchmark::kMillisecond);
BENCHMARK(add_key_frame_to_layers_and_band)->Arg(500)->Arg(5000)->Unit(benchmark::kMillisecond);

void fuse_the_map(benchmark::State& state) {
  const RoomWorld world = RoomWorld::laboratory();
  const StereoRig rig = laboratory_rig();
  FlogGrid grid(FlogOptions{});
  LocalMap local(FlogOptions{}, rig);
  for (const Pose& T_map_left : laboratory_lap(40)) {
    local.add_key_frame(T_map_left.translation(), measure(world, rig, T_map_left, 500, 0.25, 1));
    local.add_to(grid);
  }
  for (auto _ : state) benchmark::DoNotOptimize(grid.map());
}
BENCHMARK(fuse_the_map)->Unit(benchmark::kMillisecond);

/// The map of 15 key frames against that of a lap, over the whole search window.
void match_local_to_global_map(benchmark::State& state) {
  const auto mapped = [](const std::vector<Pose>& poses, uint64_t seed) {
    FlogGrid grid(FlogOptions{});
    LocalMap local(FlogOptions{}, laboratory_rig());
    for (size_t i = 0; i < poses.size(); ++i) {
      local.add_key_frame(poses[i].translation(),
                          measure(RoomWorld::laboratory(), laboratory_rig(), poses[i], 500, 0.25, seed + i));
      local.add_to(grid);
    }
    return grid.map();
  };
  const std::vector<Pose> lap = laboratory_lap(60);
  const OccupancyMap global = mapped(lap, 1);
  const OccupancyMap local = mapped({lap.begin() + 20, lap.begin() + 35}, 100);
  PlanarPose prior;
  prior.covariance.setIdentity();  // the window is as large as the options allow
  for (auto _ : state) benchmark::DoNotOptimize(match_maps(global, local, prior, MapMatchOptions{}));
}
BENCHMARK(match_local_to_global_map)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam

BENCHMARK_MAIN();
