#include "bench/runner/simulated_source.h"

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

#include "bench/runner/pair_key.h"
#include "bench/runner/priority.h"

namespace groundloop::bench {
namespace {

constexpr size_t kAhead = 6;          ///< pairs in the making, or waiting
constexpr int64_t kPairsForTwo = 30;  ///< from which two threads render

/// What the core is told of the head: ideal, or as it will be rectified.
slam::StereoRig told_rig(const sim::HeadModel& head, const std::optional<RawImages>& raw) {
  if (!raw) return head.rig();
  slam::StereoRig rig = raw->rectifier().rig();
  rig.T_body_left = head.rig().T_body_left * raw->rectifier().T_raw_left();
  return rig;
}

}  // namespace

std::future<sim::RendererInfo> renderer_from_behind(const sim::RenderSettings& settings) {
  return std::async(std::launch::async, [settings] {
    stand_back();  // Mesa's own threads start with the first context of the process, and keep its thread's
                   // priority
    return sim::renderer_info(settings);
  });
}

SimulatedSource::SimulatedSource(const sim::Scenario& scenario, const sim::World& world,
                                 const sim::HeadModel& head, const sim::RendererInfo& renderer,
                                 std::optional<int64_t> frames, sim::PairCache* cache)
    : scenario_(scenario),
      head_(head),
      raw_(head.raw ? std::make_optional<RawImages>(head, scenario) : std::nullopt),
      rig_(told_rig(head, raw_)),
      simulation_(world, head, scenario, [this](int64_t exposure) { return pose_of_exposure(exposure); }),
      arrivals_(sim::arrivals(scenario.faults, scenario.seed, simulation_.exposures(), head.period_ns())),
      size_(std::min(frames.value_or(INT64_MAX), static_cast<int64_t>(arrivals_.size()))),
      dressed_(scenario),
      ingredients_{world,
                   dressed_,
                   head,
                   scenario,
                   raw_ ? &*raw_ : nullptr,
                   cache,
                   cache != nullptr ? run_key(world, head, scenario, renderer) : sim::KeyBuilder()},
      truth_(static_cast<size_t>(size_)) {
  if (size_ > 0) return;
  throw InputError(Problem{scenario.file, scenario.faults.empty() ? 0 : scenario.faults.front().line,
                           "faults", "no pair arrives", "faults that let at least one pair through"});
}

void SimulatedSource::steer_by(const slam::FrameResult& result) {
  const bool seen =
      result.status == slam::TrackingStatus::kTracking || result.status == slam::TrackingStatus::kStarted;
  slam::Pose T_map_camera = result.T_map_left;
  if (raw_) T_map_camera = T_map_camera * raw_->rectifier().T_raw_left().inverse();
  poses_.put(seen ? std::optional(T_map_camera) : std::nullopt);
}

std::optional<slam::Pose> SimulatedSource::pose_of_exposure(int64_t exposure) {
  const auto arrival =
      std::lower_bound(arrivals_.begin(), arrivals_.end(), exposure,
                       [](const sim::Arrival& a, int64_t index) { return a.exposure < index; });
  if (arrival == arrivals_.end() || arrival->exposure != exposure) return std::nullopt;
  return poses_.wait(arrival - arrivals_.begin());
}

std::optional<sim::Exposure> SimulatedSource::expose() {
  if (exposed_ > arrivals_[static_cast<size_t>(size_) - 1].exposure) return std::nullopt;
  ++exposed_;
  return simulation_.advance();
}

slam::Pose SimulatedSource::rectified(const slam::Pose& T_world_left) const {
  return raw_ ? T_world_left * raw_->rectifier().T_raw_left() : T_world_left;
}

/// The next pair that arrives; called by one maker at a time.
std::optional<SimulatedSource::Order> SimulatedSource::order() {
  if (ordered_ == size_) return std::nullopt;
  const sim::Arrival& arrival = arrivals_[static_cast<size_t>(ordered_)];
  Order order;
  order.frame.index = ordered_++;

  // the exposures since the last pair, and the motion over all of them
  slam::Pose T_previous_left = slam::Pose::Identity();
  while (recent_.empty() || recent_.back().index < arrival.exposure) {
    std::optional<sim::Exposure> exposure = exposures_->next();
    if (!exposure) return std::nullopt;
    T_previous_left = T_previous_left * exposure->T_previous_left;
    recent_.push_back(std::move(*exposure));
  }
  while (recent_.front().index < arrival.images_of) recent_.pop_front();
  const sim::Exposure& now = recent_.back();
  order.seen = recent_.front();
  order.frame.stamp_ns = now.stamp_ns;
  if (order.frame.index > 0) {
    order.frame.T_previous_left = T_previous_left;
    if (raw_)
      order.frame.T_previous_left = raw_->rectifier().T_raw_left().inverse() * rectified(T_previous_left);
  }
  tell_truth(order, now);
  return order;
}

void SimulatedSource::tell_truth(const Order& order, const sim::Exposure& now) {
  const auto index = static_cast<size_t>(order.frame.index);
  const int64_t before_ns = index > 0 ? truth_[index - 1].stamp_ns : -1;
  FrameTruth& truth = truth_[index];
  truth.stamp_ns = now.stamp_ns;
  truth.T_world_body = now.T_world_body;
  truth.T_world_left = rectified(now.T_world_left);
  truth.T_odom_body = now.T_odom_body;
  truth.T_world_seen = rectified(order.seen.T_world_left);
  truth.seen_ns = order.seen.stamp_ns;
  truth.faults = sim::fault_label(scenario_.faults, before_ns, now.stamp_ns);
}

void SimulatedSource::start() {
  exposures_.emplace([this] { return expose(); });
  // A second maker costs a context with all textures: too much for a few pairs.
  const bool two = PairMaker::in_any_order(head_) && size_ >= kPairsForTwo;
  std::vector<OrderedPool<Order, Made>::Make> makers;
  makers.reserve(two ? 2 : 1);
  for (int i = 0; i < (two ? 2 : 1); ++i) {
    makers.emplace_back([maker = std::make_shared<PairMaker>(ingredients_)](Order order) {
      return Made{std::move(order.frame), maker->make(order.seen)};
    });
  }
  pairs_.emplace([this] { return order(); }, std::move(makers), kAhead);
}

std::optional<slam::StereoFrame> SimulatedSource::next() {
  if (!pairs_) start();
  std::optional<Made> made = pairs_->next();
  if (!made) return std::nullopt;
  return deliver(std::move(*made));
}

/// Notes what the maker tells, and sends the pair through the cable.
slam::StereoFrame SimulatedSource::deliver(Made made) {
  slam::StereoFrame frame = std::move(made.frame);
  FrameTruth& truth = truth_[static_cast<size_t>(frame.index)];
  truth.render_ms = made.pair.made_ms;
  truth.setting = made.pair.setting;
  rendered_ += made.pair.rendered ? 1 : 0;

  const bool swapped = arrivals_[static_cast<size_t>(frame.index)].swapped;
  if (raw_) {
    raw_->transfer(made.pair.left, made.pair.right, swapped, frame);
  } else {
    frame.left = swapped ? made.pair.right : made.pair.left;
    frame.right = swapped ? made.pair.left : made.pair.right;
  }
  return frame;
}

SimulatedSource::LonePair SimulatedSource::alone(int64_t index) {
  exposures_.emplace([this] { return expose(); });
  PairMaker maker(ingredients_);
  LonePair lone;
  while (std::optional<Order> now = order()) {
    const bool wanted = now->frame.index == index;
    if (now->frame.index > index) {
      lone.next = std::move(now->seen);
      lone.T_world_next = rectified(lone.next->T_world_left);
      break;
    }
    if (!wanted && PairMaker::in_any_order(head_)) continue;
    Made made{std::move(now->frame), maker.make(now->seen)};
    if (!wanted) continue;
    lone.frame = deliver(std::move(made));
    lone.seen = std::move(now->seen);
    lone.T_world_left = rectified(lone.seen.T_world_left);
  }
  return lone;
}

}  // namespace groundloop::bench
