#include "bench/runner/simulated_source.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace groundloop::bench {

SimulatedSource::SimulatedSource(const sim::Scenario& scenario, const sim::World& world,
                                 const sim::HeadModel& head, std::optional<int64_t> frames)
    : scenario_(scenario),
      world_(world),
      head_(head),
      rig_(head.rig()),
      simulation_(world, head, scenario),
      size_(std::min(frames.value_or(simulation_.exposures()), simulation_.exposures())),
      truth_(static_cast<size_t>(size_)) {}

std::optional<sim::Exposure> SimulatedSource::expose() {
  if (exposed_ == size_) return std::nullopt;
  ++exposed_;
  return simulation_.advance();
}

std::optional<slam::StereoFrame> SimulatedSource::render(sim::Renderer& renderer) {
  const std::optional<sim::Exposure> exposure = exposures_->next();
  if (!exposure) return std::nullopt;

  slam::StereoFrame frame;
  frame.index = exposure->index;
  frame.stamp_ns = exposure->stamp_ns;
  if (exposure->index > 0) frame.T_previous_left = exposure->T_previous_left;

  const auto start = std::chrono::steady_clock::now();
  renderer.update_scene(*exposure->state);
  renderer.render_grey({head_.focal_px, head_.cx_px, head_.cy_px, exposure->T_world_left}, frame.left);
  renderer.render_grey({head_.focal_px, head_.cx_px, head_.cy_px, exposure->T_world_right}, frame.right);
  const std::chrono::duration<double, std::milli> render_ms = std::chrono::steady_clock::now() - start;

  truth_[static_cast<size_t>(frame.index)] = {exposure->stamp_ns, exposure->T_world_body,
                                              exposure->T_world_left, exposure->T_odom_body,
                                              render_ms.count()};
  return frame;
}

std::optional<slam::StereoFrame> SimulatedSource::next() {
  if (!rendered_) {
    exposures_.emplace([this] { return expose(); });
    // A renderer lives and dies in the thread that uses it.
    rendered_.emplace([this, renderer = std::shared_ptr<sim::Renderer>()]() mutable {
      if (!renderer) {
        renderer = std::make_shared<sim::Renderer>(world_, head_.width_px, head_.height_px, scenario_.render);
        renderer_info_ = renderer->info();
      }
      return render(*renderer);
    });
  }
  std::optional<slam::StereoFrame> frame = rendered_->next();
  if (!frame) return std::nullopt;
  sim::apply_sensor_noise(head_.noise, scenario_.seed, 0, frame->index, frame->left);
  sim::apply_sensor_noise(head_.noise, scenario_.seed, 1, frame->index, frame->right);
  return frame;
}

}  // namespace groundloop::bench
