#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/loop/descriptors.h"
#include "slam/loop/place_index.h"
#include "tests/slam/loop/painted_room.h"

namespace groundloop::slam {
namespace {

const PaintedRoom& room() {
  static const PaintedRoom the_room(1);
  return the_room;
}

/// 400 corners of a 640 x 480 image.
void describe(benchmark::State& state) {
  cv::setNumThreads(1);
  LoopKeyFrame frame = room().key_frame(0, PaintedRoom::T_room_left(0, 0, 70));
  cv::resize(frame.left, frame.left, {}, 2, 2);
  cv::resize(2 * frame.half_disparity, frame.half_disparity, {}, 2, 2, cv::INTER_NEAREST);
  Describer describer(400);
  std::vector<Keypoint> found;
  for (auto _ : state) describer.describe(frame.left, frame.half_disparity, found);
  state.counters["keypoints"] = static_cast<double>(found.size());
}
BENCHMARK(describe)->Unit(benchmark::kMillisecond);

/// 400 descriptors against 300 views of 400, a fifth of which every view has.
void query_300_views(benchmark::State& state) {
  const auto view = [](uint64_t seed) {
    std::vector<Keypoint> keypoints(400);
    for (uint64_t i = 0; i < keypoints.size(); ++i) {
      for (uint64_t k = 0; k < 4; ++k) {
        keypoints[i].descriptor[k] = random_bits(i < 80 ? 12345 : seed, i, k);
      }
    }
    return keypoints;
  };
  PlaceIndex index;
  for (uint64_t k = 0; k < 300; ++k) index.add(view(k));
  const std::vector<Keypoint> asked = view(17);
  std::vector<PlaceCandidate> candidates;
  for (auto _ : state) index.query(asked, 300, 300, candidates);
  if (candidates.empty() || candidates[0].view != 17) state.SkipWithError("the wrong view");
}
BENCHMARK(query_300_views)->Unit(benchmark::kMillisecond);

/// A candidate that is the same place, without prediction: descriptors, search, registration, all tests.
void verify(benchmark::State& state) {
  cv::setNumThreads(1);
  const CurrentView stored = current_view(room().key_frame(0, PaintedRoom::T_room_left(0, 0, 70)));
  const CurrentView current = current_view(room().key_frame(100, PaintedRoom::T_room_left(0.2, 0.1, 65)));
  LoopVerifier verifier = make_verifier();
  Verification found;
  for (auto _ : state) found = verifier.verify(stored.view, current, std::nullopt, 1);
  if (!found.accepted) state.SkipWithError(found.message.c_str());
  state.counters["inliers"] = found.link.inliers;
}
BENCHMARK(verify)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
