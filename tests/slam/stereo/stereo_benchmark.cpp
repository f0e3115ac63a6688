#include <benchmark/benchmark.h>

#include "slam/stereo/disparity.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

void dense_disparity_640x480(benchmark::State& state) {
  const Texture texture(1, 8, 60);
  const cv::Size size(640, 480);
  const cv::Mat left = draw(size, {1, 0, 1.5, 3}, [&](int u, int v) { return texture.at(u, v); });
  const cv::Mat right = draw(size, {1, 0, 1.5, 4}, [&](int u, int v) { return texture.at(u + 20, v); });
  DenseDisparity dense({});
  for (auto _ : state) dense.compute(left, right);
}
BENCHMARK(dense_disparity_640x480)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
