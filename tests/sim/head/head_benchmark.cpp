// Times of what makes and takes a raw image of 640 x 480: build/release/benchmark_head
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "sim/head/calibration_file.h"
#include "sim/head/head.h"
#include "slam/rectify/rectifier.h"

namespace groundloop::sim {
namespace {

struct Fixture {
  HeadModel head = load_head("models/heads/sth_mdcs_raw.yaml");
  RawCamera camera{*head.raw, head.width_px, head.height_px, 0};
  ExposureSetting setting{head.raw->exposure.time_s, head.raw->exposure.gain_db};
  cv::Mat rendered{camera.view().size, CV_8UC1}, level, grey;

  Fixture() {
    cv::randu(rendered, 20, 200);
    camera.see(rendered, level);
    camera.read_out(level, setting, 1, 0, grey);
  }
};

void make_lens_table(benchmark::State& state) {
  const HeadModel head = load_head("models/heads/sth_mdcs_raw.yaml");
  for (auto _ : state) RawCamera(*head.raw, head.width_px, head.height_px, 0);
}
BENCHMARK(make_lens_table)->Unit(benchmark::kMillisecond);

void light_of_a_sub_frame(benchmark::State& state) {
  Fixture f;
  for (auto _ : state) f.camera.see(f.rendered, f.level);
}
BENCHMARK(light_of_a_sub_frame)->Unit(benchmark::kMillisecond);

void integrate_sub_frames(benchmark::State& state) {
  const Fixture f;
  const std::vector<cv::Mat> levels(static_cast<size_t>(f.head.raw->exposure.sub_frames), f.level);
  cv::Mat level;
  for (auto _ : state) f.camera.integrate(levels, f.setting, level);
}
BENCHMARK(integrate_sub_frames)->Unit(benchmark::kMillisecond);

void read_out(benchmark::State& state) {
  Fixture f;
  int64_t frame = 0;
  for (auto _ : state) f.camera.read_out(f.level, f.setting, 1, frame++, f.grey);
}
BENCHMARK(read_out)->Unit(benchmark::kMillisecond);

void rectify_a_pair(benchmark::State& state) {
  const Fixture f;
  const slam::Rectifier rectifier(slam::parse_stereo_calibration(calibration_yaml(f.head), "head"),
                                  f.grey.size());
  cv::Mat left, right;
  for (auto _ : state) rectifier.rectify(f.grey, f.grey, left, right);
}
BENCHMARK(rectify_a_pair)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::sim
