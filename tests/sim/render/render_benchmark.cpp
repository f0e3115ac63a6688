// What images cost: the pairs of lab_p3dx's drive, rendered and read back with nothing beside it. A whole run
// over the same pairs may take 1.1 times as long (docs/rendering.md).
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/render/renderer.h"
#include "sim/simulation/carried_head.h"
#include "sim/simulation/simulation.h"

namespace groundloop::sim {
namespace {

constexpr int kPairs = 30;
constexpr int kEvery = 50;  // of the drive's 1500 pairs

struct Drive {
  Drive()
      : scenario(load_scenario("scenarios/lab_p3dx.yaml")),
        head(carried_head(scenario)),
        world(World::load(scenario)),
        simulation(world, head, scenario) {
    for (int i = 0; i < kPairs * kEvery; ++i) {
      auto exposure = simulation.advance();
      if (i % kEvery == 0) exposures.push_back(std::move(*exposure));
    }
  }
  const Scenario scenario;
  const HeadModel head;
  const World world;
  Simulation simulation;
  std::vector<Exposure> exposures;
};

const Drive& drive() {
  static const Drive the_drive;
  return the_drive;
}

void render_all(benchmark::State& state, const World& world, const RenderSettings& settings) {
  const HeadModel& head = drive().head;
  Renderer renderer(world, head.width_px, head.height_px, settings);
  const bool own_world = &world != &drive().world;
  const World::DataPtr empty = world.make_data();
  cv::Mat grey;
  for (auto _ : state) {
    for (const Exposure& exposure : drive().exposures) {
      renderer.update_scene(own_world ? *empty : *exposure.state);
      renderer.render_grey({head.focal_px, head.cx_px, head.cy_px, exposure.T_world_left}, grey);
      renderer.render_grey({head.focal_px, head.cx_px, head.cy_px, exposure.T_world_right}, grey);
    }
  }
  state.counters["pairs"] =
      benchmark::Counter(static_cast<double>(kPairs), benchmark::Counter::kIsIterationInvariantRate);
}

RenderSettings settings_of(RenderProfile profile) {
  RenderChoice choice;
  choice.profile = profile;
  return choice.settings();
}

void laboratory(benchmark::State& state, RenderProfile profile) {
  render_all(state, drive().world, settings_of(profile));
}
BENCHMARK_CAPTURE(laboratory, fast, RenderProfile::kFast)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(laboratory, standard, RenderProfile::kStandard)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(laboratory, faithful, RenderProfile::kFaithful)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The same images of an empty scene: what is left are contexts, clearing and reading back.
void nothing(benchmark::State& state, RenderProfile profile) {
  const auto file = std::filesystem::temp_directory_path() / "groundloop_benchmark_nothing.xml";
  std::ofstream(file) << "<mujoco><worldbody><geom size='0.01' pos='0 0 -9'/></worldbody></mujoco>";
  const World world = World::load_file(file.string());
  std::filesystem::remove(file);
  render_all(state, world, settings_of(profile));
}
BENCHMARK_CAPTURE(nothing, fast, RenderProfile::kFast)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(nothing, standard, RenderProfile::kStandard)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace groundloop::sim
