#include <benchmark/benchmark.h>

#include <filesystem>
#include <vector>

#include "sim/cache/pair_cache.h"
#include "sim/cache/pair_codec.h"
#include "tests/sim/cache/noisy_pair.h"

namespace groundloop::sim {
namespace {

const cv::Size kVga(640, 480);

void pack(benchmark::State& state) {
  const cv::Mat left = noisy_image(kVga, 1), right = noisy_image(kVga, 2);
  std::vector<uint8_t> bytes;
  for (auto _ : state) pack_pair(left, right, bytes);
  state.counters["of_raw"] =
      static_cast<double>(bytes.size()) / static_cast<double>(left.total() + right.total());
}
BENCHMARK(pack)->Unit(benchmark::kMillisecond);

void find(benchmark::State& state) {
  const auto folder = std::filesystem::temp_directory_path() / "groundloop_benchmark_cache";
  PairCache cache(folder.string());
  KeyBuilder builder;
  cache.store(builder.key(), noisy_image(kVga, 1), noisy_image(kVga, 2));
  cv::Mat left, right;
  for (auto _ : state) benchmark::DoNotOptimize(cache.find(builder.key(), kVga, left, right));
  std::filesystem::remove_all(folder);
}
BENCHMARK(find)->Unit(benchmark::kMillisecond);

/// What a key costs: the poses of a furnished room's geoms.
void key(benchmark::State& state) {
  const std::vector<double> poses(12 * 1000, 0.25);
  const KeyBuilder run;
  for (auto _ : state) {
    KeyBuilder builder(run);
    builder.add(poses.data(), poses.size());
    benchmark::DoNotOptimize(builder.key());
  }
}
BENCHMARK(key)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::sim
