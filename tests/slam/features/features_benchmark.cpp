#include <benchmark/benchmark.h>

#include "slam/features/affine_klt.h"
#include "slam/features/detector.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

cv::Mat picture(double shift_px) {
  const Texture texture(1, 8, 60);
  return draw({640, 480}, {1, 0, 1.5, 3}, [&](int u, int v) { return texture.at(u + shift_px, v); });
}

ImagePyramid pyramid_of(const cv::Mat& image) {
  ImagePyramid pyramid;
  pyramid.build(image, 4);
  return pyramid;
}

void build_pyramid_640x480(benchmark::State& state) {
  const cv::Mat image = picture(0);
  ImagePyramid pyramid;
  for (auto _ : state) pyramid.build(image, 4);
}
BENCHMARK(build_pyramid_640x480)->Unit(benchmark::kMillisecond);

void detect_400_640x480(benchmark::State& state) {
  const cv::Mat image = picture(0);
  Detector detector({});
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(image, {}, 400, 18).size());
}
BENCHMARK(detect_400_640x480)->Unit(benchmark::kMillisecond);

void take_first_view(benchmark::State& state) {
  const ImagePyramid pyramid = pyramid_of(picture(0));
  PatchTemplate patch;
  for (auto _ : state) benchmark::DoNotOptimize(patch.take(pyramid, {320.4F, 240.3F}, 4));
}
BENCHMARK(take_first_view)->Unit(benchmark::kMicrosecond);

/// One feature from a prediction that is 1.5 px off, coarsest level 1.
void track_one_feature(benchmark::State& state) {
  const ImagePyramid first = pyramid_of(picture(0)), second = pyramid_of(picture(1.5));
  PatchTemplate patch;
  patch.take(first, {320.4F, 240.3F}, 4);
  for (auto _ : state) {
    AffineState where;
    where.uv_px = {320.4F, 240.3F};
    if (track_affine(patch, second, {}, 1, where) != KltStatus::kTracked) state.SkipWithError("not tracked");
  }
}
BENCHMARK(track_one_feature)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace groundloop::slam
