#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sim/head/head.h"
#include "sim/render/renderer.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "slam/rectify/rectifier.h"
#include "slam/rectify/transfer.h"
#include "slam/types/stereo_frame.h"

namespace groundloop::bench {

/// Light on the two sensors of a raw head during one exposure, moment by moment (CV_32FC1).
using SensorLight = std::array<std::vector<cv::Mat>, 2>;

/// The images of a raw head, from the scene to what the core gets: light, sensors, cable; and then the core's
/// own code, which knows the calibration file only.
class RawImages {
 public:
  /// Both must outlive this object.
  /// @throws InputError when the calibration that the head's file tells cannot be used
  RawImages(const sim::HeadModel& head, const sim::Scenario& scenario);

  /// Of the images that the renderer must make.
  const sim::RenderView& view() const { return cameras_[0].view(); }
  const slam::Rectifier& rectifier() const { return rectifier_; }

  /// Renders an exposure. May run in another thread than the rest.
  SensorLight light(const sim::Exposure& exposure, sim::Renderer& renderer) const;

  /// The setting of the left camera for an exposure. Exposures are asked for in order; those that never
  /// arrive are not seen by the exposure control either, and one that arrives again has the setting it had.
  sim::ExposureSetting setting(int64_t exposure);
  /// Makes the raw pair: a function of (light, head, faults, seed, exposure, setting) alone.
  void read_out(const SensorLight& light, int64_t exposure, const sim::ExposureSetting& setting,
                cv::Mat& left, cv::Mat& right) const;
  /// What the exposure control learns from the raw pair of the setting asked for last.
  void observe(const cv::Mat& left);
  /// Sends a raw pair and rectifies what arrives.
  /// @param swapped  the cable has the cameras in the wrong order
  void transfer(const cv::Mat& left, const cv::Mat& right, bool swapped, slam::StereoFrame& frame) const;

 private:
  cv::Mat rendered_light(int camera, const slam::Pose& T_world_camera, sim::Renderer& renderer) const;

  const sim::HeadModel& head_;
  const sim::Scenario& scenario_;
  std::array<sim::RawCamera, 2> cameras_;
  slam::Rectifier rectifier_;
  slam::ColourFilter filter_;
  sim::ExposureControl control_;
  std::optional<int64_t> set_for_;
  sim::ExposureSetting setting_;
  bool observed_ = false;
};

}  // namespace groundloop::bench
