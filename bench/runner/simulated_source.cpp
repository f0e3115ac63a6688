#include "bench/runner/simulated_source.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "sim/faults/image_faults.h"

namespace groundloop::bench {
namespace {

/// What the core is told of the head: ideal, or as it will be rectified.
slam::StereoRig told_rig(const sim::HeadModel& head, const std::optional<RawImages>& raw) {
  if (!raw) return head.rig();
  slam::StereoRig rig = raw->rectifier().rig();
  rig.T_body_left = head.rig().T_body_left * raw->rectifier().T_raw_left();
  return rig;
}

}  // namespace

SimulatedSource::SimulatedSource(const sim::Scenario& scenario, const sim::World& world,
                                 const sim::HeadModel& head, std::optional<int64_t> frames)
    : scenario_(scenario),
      world_(world),
      head_(head),
      raw_(head.raw ? std::make_optional<RawImages>(head, scenario) : std::nullopt),
      rig_(told_rig(head, raw_)),
      simulation_(world, head, scenario, [this](int64_t exposure) { return pose_of_exposure(exposure); }),
      arrivals_(sim::arrivals(scenario.faults, scenario.seed, simulation_.exposures(), head.period_ns())),
      size_(std::min(frames.value_or(INT64_MAX), static_cast<int64_t>(arrivals_.size()))),
      truth_(static_cast<size_t>(size_)) {
  if (size_ > 0) return;
  throw InputError(Problem{scenario.file, scenario.faults.empty() ? 0 : scenario.faults.front().line,
                           "faults", "no pair arrives", "faults that let at least one pair through"});
}

void SimulatedSource::steer_by(const slam::FrameResult& result) {
  const bool known = result.status != slam::TrackingStatus::kLost;
  slam::Pose T_map_camera = result.T_map_left;
  if (raw_) T_map_camera = T_map_camera * raw_->rectifier().T_raw_left().inverse();
  poses_.put(known ? std::optional(T_map_camera) : std::nullopt);
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

std::optional<SimulatedSource::Rendered> SimulatedSource::make_pair(sim::Renderer& renderer) {
  if (made_ == size_) return std::nullopt;
  const sim::Arrival& arrival = arrivals_[static_cast<size_t>(made_)];
  Rendered pair;
  slam::StereoFrame& frame = pair.frame;
  frame.index = made_++;

  const auto rectified = [this](const slam::Pose& T_world_left) {
    return raw_ ? T_world_left * raw_->rectifier().T_raw_left() : T_world_left;
  };

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
  const sim::Exposure& seen = recent_.front();
  frame.stamp_ns = now.stamp_ns;
  if (frame.index > 0) {
    frame.T_previous_left = T_previous_left;
    if (raw_) frame.T_previous_left = raw_->rectifier().T_raw_left().inverse() * rectified(T_previous_left);
  }

  const auto start = std::chrono::steady_clock::now();
  if (raw_) {
    pair.light = raw_->light(seen, renderer);
  } else {
    render(seen, renderer, frame);
  }
  const std::chrono::duration<double, std::milli> render_ms = std::chrono::steady_clock::now() - start;

  const int64_t before_ns = frame.index > 0 ? truth_[static_cast<size_t>(frame.index) - 1].stamp_ns : -1;
  const std::string faults = sim::fault_label(scenario_.faults, before_ns, now.stamp_ns);
  FrameTruth& truth = truth_[static_cast<size_t>(frame.index)];
  truth.stamp_ns = now.stamp_ns;
  truth.T_world_body = now.T_world_body;
  truth.T_world_left = rectified(now.T_world_left);
  truth.T_odom_body = now.T_odom_body;
  truth.T_world_seen = rectified(seen.T_world_left);
  truth.seen_ns = seen.stamp_ns;
  truth.faults = faults;
  truth.render_ms = render_ms.count();
  return pair;
}

void SimulatedSource::render(const sim::Exposure& exposure, sim::Renderer& renderer,
                             slam::StereoFrame& frame) const {
  renderer.update_scene(*exposure.state, exposure.lights);
  renderer.render_grey({head_.focal_px, head_.cx_px, head_.cy_px, exposure.T_world_left}, frame.left);
  if (exposure.state_right != exposure.state) renderer.update_scene(*exposure.state_right, exposure.lights);
  renderer.render_grey({head_.focal_px, head_.cx_px, head_.cy_px, exposure.T_world_right}, frame.right);
}

/// What lens, light and sensor make of a rendered pair, and the cable of their order.
void SimulatedSource::spoil(slam::StereoFrame& frame) const {
  const sim::Arrival& arrival = arrivals_[static_cast<size_t>(frame.index)];
  const double time_s = static_cast<double>(arrival.images_of * head_.period_ns()) * 1e-9;
  for (const auto& [camera, image] : {std::pair(0, &frame.left), std::pair(1, &frame.right)}) {
    sim::apply_image_faults(scenario_.faults, scenario_.seed, camera, time_s, *image);
    sim::apply_sensor_noise(head_.noise, scenario_.seed, camera, arrival.images_of, *image);
  }
  if (arrival.swapped) cv::swap(frame.left, frame.right);
}

/// From the light on the sensors to the rectified pair.
void SimulatedSource::take_raw(Rendered& pair) {
  const sim::Arrival& arrival = arrivals_[static_cast<size_t>(pair.frame.index)];
  const sim::ExposureSetting setting = raw_->setting(arrival.images_of);
  cv::Mat left, right;
  raw_->read_out(pair.light, arrival.images_of, setting, left, right);
  raw_->observe(left);
  raw_->transfer(left, right, arrival.swapped, pair.frame);
  truth_[static_cast<size_t>(pair.frame.index)].setting = setting;
}

std::optional<slam::StereoFrame> SimulatedSource::next() {
  if (!rendered_) {
    exposures_.emplace([this] { return expose(); });
    // A renderer lives and dies in the thread that uses it.
    rendered_.emplace([this, renderer = std::shared_ptr<sim::Renderer>()]() mutable {
      if (!renderer) {
        const cv::Size size = raw_ ? raw_->view().size : cv::Size(head_.width_px, head_.height_px);
        renderer = std::make_shared<sim::Renderer>(world_, size.width, size.height, scenario_.render);
        renderer_info_ = renderer->info();
      }
      return make_pair(*renderer);
    });
  }
  std::optional<Rendered> pair = rendered_->next();
  if (!pair) return std::nullopt;
  if (raw_) {
    take_raw(*pair);
  } else {
    spoil(pair->frame);
  }
  return std::move(pair->frame);
}

}  // namespace groundloop::bench
