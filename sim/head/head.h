#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/head/raw_head.h"
#include "slam/types/config.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::sim {

/// Where the left camera sits on the robot: position in the body frame, then pan (left), tilt (up), roll.
struct HeadMount {
  double x_m = 0;
  double y_m = 0;  ///< of the left camera, positive to the left
  double z_m = 0.35;
  double pan_deg = 0;
  double tilt_deg = 0;
  double roll_deg = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -2, .max = 2});
    a("y_m", y_m, {.min = -2, .max = 2});
    a("z_m", z_m, {.min = 0.01, .max = 3});
    a("pan_deg", pan_deg, {.min = -180, .max = 180});
    a("tilt_deg", tilt_deg, {.min = -89, .max = 89});
    a("roll_deg", roll_deg, {.min = -180, .max = 180});
  }
};

/// The simple sensor of an ideal head: shot noise (variance proportional to grey value) and read noise, 8-bit
/// quantisation.
struct HeadNoise {
  double read_grey = 1.5;             ///< standard deviation in the dark [grey levels]
  double shot_grey_per_level = 0.01;  ///< variance added per grey level [grey^2 / grey]

  template <class Archive>
  void visit(Archive& a) {
    a("read_grey", read_grey, {.min = 0, .max = 64});
    a("shot_grey_per_level", shot_grey_per_level, {.min = 0, .max = 10});
  }
};

/// A stereo head, as models/heads/*.yaml describes it. Either ideal: a rectified pair of pinhole cameras
/// whose images are rendered as they are and get simple noise. Or raw (`raw`): lenses, sensors, shutter.
struct HeadModel {
  std::string name;
  std::string summary;
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 7.5;
  double baseline_m = 0.088;
  double focal_px = 576.92;
  double cx_px = 319.5;  ///< of the left and right image; the centre of the first pixel is (0, 0)
  double cy_px = 239.5;
  HeadMount mount;
  HeadNoise noise;
  std::optional<RawHead> raw;  ///< in place of focal_px, cx_px, cy_px, noise

  template <class Archive>
  void visit(Archive& a) {
    a("name", name, {.required = true});
    a("summary", summary);
    a("width_px", width_px, {.min = 32, .max = 4096});
    a("height_px", height_px, {.min = 32, .max = 4096});
    a("rate_hz", rate_hz, {.min = 0.1, .max = 120});
    a("baseline_m", baseline_m, {.min = 0.001, .max = 2});
    a("mount", mount);
    a("raw", raw);
    if (raw) return;  // in place of what follows
    a("focal_px", focal_px, {.min = 10, .max = 20000});
    a("cx_px", cx_px, {.min = -1000, .max = 6000});
    a("cy_px", cy_px, {.min = -1000, .max = 6000});
    a("noise", noise);
  }
  void check(ConfigReader& reader) const;

  /// The ideal head; of a raw one, the rectified pair with its left lens' focal length, without distortion.
  /// T_body_left is that of the camera itself in both.
  slam::StereoRig rig() const;
  /// Pose of the right camera in the left one.
  slam::Pose T_left_right() const;
  int64_t period_ns() const;
  /// When the scene is rendered for one image, from its stamp; {0} for an ideal head.
  std::vector<double> sub_frame_times_s() const;
};

/// @throws InputError
HeadModel load_head(const std::string& file);

/// Turns rendered grey images (CV_8UC1) into what the sensor delivers, in place. Every pixel's noise depends
/// only on (seed, camera, frame, pixel): any frame can be made again alone.
/// @param camera 0 left, 1 right
void apply_sensor_noise(const HeadNoise& noise, uint64_t seed, int camera, int64_t frame, cv::Mat& image);

}  // namespace groundloop::sim
