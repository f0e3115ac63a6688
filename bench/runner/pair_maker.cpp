#include "bench/runner/pair_maker.h"

#include <chrono>
#include <utility>

#include "bench/runner/pair_key.h"
#include "sim/faults/image_faults.h"

namespace groundloop::bench {

bool PairMaker::in_any_order(const sim::HeadModel& head) {
  return !head.raw || !head.raw->exposure.automatic;
}

PairMaker::Pair PairMaker::make(const sim::Exposure& exposure) {
  const auto start = std::chrono::steady_clock::now();
  Pair pair;
  if (of_.raw != nullptr) pair.setting = raw_setting(exposure);
  std::optional<sim::ContentKey> key;
  if (of_.cache != nullptr) key = pair_key(of_.run, of_.world, of_.scenario, exposure, pair.setting);
  const cv::Size size(of_.head.width_px, of_.head.height_px);
  if (!key || !of_.cache->find(*key, size, pair.left, pair.right)) {
    render(exposure, pair);
    if (key) of_.cache->store(*key, pair.left, pair.right);
  }
  if (!in_any_order(of_.head)) of_.raw->observe(pair.left);
  pair.made_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return pair;
}

sim::ExposureSetting PairMaker::raw_setting(const sim::Exposure& exposure) const {
  if (!in_any_order(of_.head)) return of_.raw->setting(exposure.index);
  return sim::ExposureControl(of_.head.raw->exposure).next();  // always the same
}

sim::Renderer& PairMaker::renderer() {
  if (!renderer_) {
    const cv::Size size =
        of_.raw != nullptr ? of_.raw->view().size : cv::Size(of_.head.width_px, of_.head.height_px);
    renderer_ = std::make_unique<sim::Renderer>(of_.dressed.get(), size.width, size.height,
                                                of_.scenario.render.settings());
  }
  return *renderer_;
}

void PairMaker::render(const sim::Exposure& exposure, Pair& pair) {
  pair.rendered = true;
  if (of_.raw == nullptr) return render_ideal(exposure, pair);
  const SensorLight light = of_.raw->light(exposure, renderer());
  of_.raw->read_out(light, exposure.index, *pair.setting, pair.left, pair.right);
}

void PairMaker::render_ideal(const sim::Exposure& exposure, Pair& pair) {
  const sim::HeadModel& head = of_.head;
  sim::Renderer& view = renderer();
  view.update_scene(*exposure.state, exposure.lights);
  view.render_grey({head.focal_px, head.cx_px, head.cy_px, exposure.T_world_left}, pair.left);
  if (exposure.state_right != exposure.state) view.update_scene(*exposure.state_right, exposure.lights);
  view.render_grey({head.focal_px, head.cx_px, head.cy_px, exposure.T_world_right}, pair.right);

  const double time_s = static_cast<double>(exposure.stamp_ns) * 1e-9;
  const sim::Scenario& scenario = of_.scenario;
  for (const auto& [camera, image] : {std::pair(0, &pair.left), std::pair(1, &pair.right)}) {
    sim::apply_image_faults(scenario.faults, scenario.seed, camera, time_s, *image);
    sim::apply_sensor_noise(head.noise, scenario.seed, camera, exposure.index, *image);
  }
}

}  // namespace groundloop::bench
