#include "bench/runner/raw_images.h"

#include <opencv2/core.hpp>

#include "sim/faults/image_faults.h"
#include "sim/head/calibration_file.h"
#include "sim/head/transfer.h"

namespace groundloop::bench {
namespace {

slam::ColourFilter filter_of(const sim::SensorModel& sensor) {
  // the mean of a whole group of four colours is grey already
  if (sensor.reduction == sim::Reduction::kBinning) return slam::ColourFilter::kNone;
  switch (sensor.mosaic) {
    case sim::Mosaic::kNone:
      return slam::ColourFilter::kNone;
    case sim::Mosaic::kRggb:
      return slam::ColourFilter::kRggb;
    case sim::Mosaic::kGrbg:
      return slam::ColourFilter::kGrbg;
    case sim::Mosaic::kGbrg:
      return slam::ColourFilter::kGbrg;
    case sim::Mosaic::kBggr:
      return slam::ColourFilter::kBggr;
  }
  return slam::ColourFilter::kNone;
}

sim::RawCamera camera_of(const sim::HeadModel& head, int camera) {
  return {head.raw.value(), head.width_px, head.height_px, camera};
}

/// One moment, seen by both cameras.
struct Moment {
  const mjData* state;
  const sim::LightFactors* lights;
  slam::Pose T_world_camera;
};

/// The moments of one camera's exposure; the same again and again when nothing moves.
std::vector<Moment> moments(const std::vector<sim::SubFrame>& sub_frames, const Moment& still, size_t count) {
  if (sub_frames.empty()) return std::vector<Moment>(count, still);
  std::vector<Moment> all;
  for (const sim::SubFrame& sub : sub_frames) {
    all.push_back({sub.state.get(), &sub.lights, sub.T_world_camera});
  }
  return all;
}

}  // namespace

RawImages::RawImages(const sim::HeadModel& head, const sim::Scenario& scenario)
    : head_(head),
      scenario_(scenario),
      cameras_{camera_of(head, 0), camera_of(head, 1)},
      rectifier_(slam::parse_stereo_calibration(sim::calibration_yaml(head), scenario.head.model),
                 {head.width_px, head.height_px}),
      filter_(filter_of(head.raw->sensor)),
      control_(head.raw->exposure) {}

cv::Mat RawImages::rendered_light(int camera, const slam::Pose& T_world_camera,
                                  sim::Renderer& renderer) const {
  const sim::RawCamera& eye = cameras_[static_cast<size_t>(camera)];
  const sim::Renderer::Camera pinhole{eye.view().focal_px, eye.view().cx_px, eye.view().cy_px,
                                      T_world_camera};
  cv::Mat rendered, level;
  if (eye.wants_colour()) {
    renderer.render_bgr(pinhole, rendered);
  } else {
    renderer.render_grey(pinhole, rendered);
  }
  eye.see(rendered, level);
  return level;
}

SensorLight RawImages::light(const sim::Exposure& exposure, sim::Renderer& renderer) const {
  const auto count = static_cast<size_t>(head_.raw->exposure.sub_frames);
  const std::vector<Moment> left = moments(
      exposure.left_sub_frames, {exposure.state.get(), &exposure.lights, exposure.T_world_left}, count);
  const std::vector<Moment> right =
      moments(exposure.right_sub_frames,
              {exposure.state_right.get(), &exposure.lights, exposure.T_world_right}, count);
  const bool still = exposure.left_sub_frames.empty();
  SensorLight light;
  for (size_t k = 0; k < count; ++k) {
    if (still && k > 0) {  // nothing moves
      for (std::vector<cv::Mat>& levels : light) levels.push_back(levels.front());
      continue;
    }
    renderer.update_scene(*left[k].state, *left[k].lights);
    light[0].push_back(rendered_light(0, left[k].T_world_camera, renderer));
    if (right[k].state != left[k].state) renderer.update_scene(*right[k].state, *right[k].lights);
    light[1].push_back(rendered_light(1, right[k].T_world_camera, renderer));
  }
  return light;
}

sim::ExposureSetting RawImages::setting(int64_t exposure) {
  if (set_for_ != exposure) {
    setting_ = control_.next();
    set_for_ = exposure;
    observed_ = false;
  }
  return setting_;
}

void RawImages::read_out(const SensorLight& light, int64_t exposure, const sim::ExposureSetting& setting,
                         cv::Mat& left, cv::Mat& right) const {
  const double time_s = static_cast<double>(exposure * head_.period_ns()) * 1e-9;
  for (const int camera : {0, 1}) {
    const sim::RawCamera& eye = cameras_[static_cast<size_t>(camera)];
    const sim::ExposureSetting own = camera == 0 ? setting : sim::right_setting(head_.raw->exposure, setting);
    cv::Mat level;
    eye.integrate(light[static_cast<size_t>(camera)], own, level);
    sim::apply_image_faults(scenario_.faults, scenario_.seed, camera, time_s, level,
                            eye.sensor_pixels_per_px());
    eye.read_out(level, own, scenario_.seed, exposure, camera == 0 ? left : right);
  }
}

void RawImages::observe(const cv::Mat& left) {
  if (observed_) return;
  control_.observe(cv::mean(left)[0] - head_.raw->sensor.black_dn);
  observed_ = true;
}

void RawImages::transfer(const cv::Mat& left, const cv::Mat& right, bool swapped,
                         slam::StereoFrame& frame) const {
  const std::vector<uint8_t> bytes = swapped ? sim::interleaved(right, left) : sim::interleaved(left, right);

  cv::Mat raw_left, raw_right;
  slam::deinterleave(bytes, left.size(), slam::FirstByte::kRight, raw_left, raw_right);
  slam::mosaic_to_grey(filter_, raw_left);
  slam::mosaic_to_grey(filter_, raw_right);
  rectifier_.rectify(raw_left, raw_right, frame);
}

}  // namespace groundloop::bench
