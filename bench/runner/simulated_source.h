#pragma once

#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/runner/ahead.h"
#include "bench/runner/ordered_pool.h"
#include "bench/runner/pair_maker.h"
#include "bench/runner/pose_channel.h"
#include "bench/runner/raw_images.h"
#include "sim/faults/arrivals.h"
#include "sim/head/head.h"
#include "sim/render/renderer.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"
#include "slam/source/stereo_source.h"
#include "slam/types/frame_result.h"

namespace groundloop::bench {

/// What the bench knows of a pair and the core must not.
struct FrameTruth {
  int64_t stamp_ns = 0;
  slam::Pose T_world_body = slam::Pose::Identity();
  slam::Pose T_world_left = slam::Pose::Identity();
  slam::Pose T_odom_body = slam::Pose::Identity();
  slam::Pose T_world_seen =
      slam::Pose::Identity();  ///< left camera when the images were taken: T_world_left but for late pairs
  int64_t seen_ns = 0;         ///< when that was
  std::string faults;          ///< kinds active since the pair before, as "drop+blur" (sim/faults/arrivals.h)
  double render_ms = 0;        ///< both images, as the head delivers them: rendered, or found in the cache
  std::optional<sim::ExposureSetting> setting;  ///< of a raw head's left camera
};

/// Starts Mesa, behind whoever calls, and tells what it is: a fifth of a second in which the world may be
/// read.
std::future<sim::RendererInfo> renderer_from_behind(const sim::RenderSettings& settings);

/// The simulator as a source of stereo pairs. Physics runs ahead in a thread of its own, rendering in two:
/// one prepares its triangles while Mesa's own threads fill those of the other. The truth of each pair goes
/// past the core, into truth().
///
/// The pairs of a raw head are rectified as the core is told; truth, planned motion and the poses to steer by
/// are those of the rectified left camera.
///
/// A pair that does not arrive (faults: drop, late) leaves no gap in the index, only in the stamps; the
/// planned motion told with the next pair covers the whole gap, since the robot kept count of it.
class SimulatedSource : public slam::StereoSource {
 public:
  /// @param world   the scenario's; textures are not needed, the source reads them when it renders
  /// @param renderer  what makes the images that are not found in the cache (renderer_from_behind())
  /// @param frames  deliver only the first so many pairs
  /// @param cache   where finished pairs are looked for and left; null: all are rendered. Must outlive the
  /// source
  /// @throws InputError when the scenario's models do not fit together or its plan runs into something
  SimulatedSource(const sim::Scenario& scenario, const sim::World& world, const sim::HeadModel& head,
                  const sim::RendererInfo& renderer, std::optional<int64_t> frames,
                  sim::PairCache* cache = nullptr);
  ~SimulatedSource() override { abandon(); }

  const slam::StereoRig& rig() const override { return rig_; }
  std::optional<int64_t> size() const override { return size_; }
  /// All calls must come from one thread. Under `feedback: slam` a pair may wait for the result of the pairs
  /// before the last sim::kFeedbackPairs.
  std::optional<slam::StereoFrame> next() override;

  /// A pair made alone, with the scene that it and the pair after it show.
  struct LonePair {
    slam::StereoFrame frame;
    sim::Exposure seen;
    slam::Pose T_world_left = slam::Pose::Identity();  ///< of the delivered left image
    std::optional<sim::Exposure> next;                 ///< none after the last pair
    slam::Pose T_world_next = slam::Pose::Identity();  ///< of its left image
  };
  /// Pair `index` and no other, in place of all calls of next(): the same bytes. Only a head with automatic
  /// exposure makes the pairs before it, too, since its exposure follows from them.
  LonePair alone(int64_t index);

  /// What the core said of the next pair, in order: the robot may steer by it.
  void steer_by(const slam::FrameResult& result);
  /// There will be no more results: whoever waits for one goes on without.
  void abandon() { poses_.close(); }

  /// Truth of pair `index`. May be read from another thread once that pair was delivered to it.
  const FrameTruth& truth(int64_t index) const { return truth_[static_cast<size_t>(index)]; }
  /// Pairs delivered that were rendered, not found in the cache.
  int64_t rendered() const { return rendered_; }
  const sim::Simulation& simulation() const { return simulation_; }

 private:
  std::optional<slam::Pose> pose_of_exposure(int64_t exposure);
  std::optional<sim::Exposure> expose();
  /// What a maker is told of a pair.
  struct Order {
    slam::StereoFrame frame;  ///< without images
    sim::Exposure seen;       ///< whose images they are
  };
  struct Made {
    slam::StereoFrame frame;  ///< without images
    PairMaker::Pair pair;
  };
  std::optional<Order> order();
  void tell_truth(const Order& order, const sim::Exposure& now);
  void start();
  slam::StereoFrame deliver(Made made);
  slam::Pose rectified(const slam::Pose& T_world_left) const;

  const sim::Scenario& scenario_;
  const sim::HeadModel& head_;
  std::optional<RawImages> raw_;
  const slam::StereoRig rig_;
  PoseChannel poses_;
  sim::Simulation simulation_;
  const std::vector<sim::Arrival> arrivals_;
  const int64_t size_;
  DressedWorld dressed_;
  const PairIngredients ingredients_;
  std::vector<FrameTruth> truth_;
  int64_t exposed_ = 0;
  int64_t ordered_ = 0;
  int64_t rendered_ = 0;
  std::deque<sim::Exposure> recent_;               ///< whose images may still arrive
  std::optional<Ahead<sim::Exposure>> exposures_;  ///< started by the first next()
  std::optional<OrderedPool<Order, Made>> pairs_;  ///< takes from exposures_, so it ends first
};

}  // namespace groundloop::bench
