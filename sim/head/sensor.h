#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sim/head/exposure.h"
#include "sim/head/pixel_grid.h"

namespace groundloop::sim {

/// A linear image sensor in the terms of the EMVA standard 1288 (release 3.1, section 2). Everything is per
/// sensor pixel; DN are grey levels of the delivered 8-bit image.
struct SensorModel {
  int64_t serial = 1;                ///< two heads of one type differ in the pattern of their pixels by this
  double white_photons_per_s = 3e6;  ///< that a rendered white (255) surface sends to a pixel in the middle
  double quantum_efficiency = 0.5;   ///< electrons a photon
  double full_well_e = 30000;
  double gain_dn_per_e = 0.0085;  ///< K, at 0 dB
  double black_dn = 0;            ///< delivered without light and noise
  double read_noise_e = 12;       ///< standard deviation in the dark, without quantisation
  double dark_current_eps = 100;  ///< electrons a second; they bring shot noise, too
  double prnu_percent = 1;        ///< standard deviation of the pixels' sensitivities
  double dsnu_e = 5;              ///< standard deviation of the pixels' dark values
  double hot_pixels_ppm = 50;     ///< share of pixels with `hot_current_eps` in place of the dark current
  double hot_current_eps = 50000;
  Reduction reduction = Reduction::kNone;
  int factor = 2;  ///< of the reduction, along each axis
  Mosaic mosaic = Mosaic::kNone;

  template <class Archive>
  void visit(Archive& a) {
    a("serial", serial, {.min = 0, .max = 1e15});
    a("white_photons_per_s", white_photons_per_s, {.min = 1, .max = 1e12});
    a("quantum_efficiency", quantum_efficiency, {.min = 0.001, .max = 1});
    a("full_well_e", full_well_e, {.min = 10, .max = 1e7});
    a("gain_dn_per_e", gain_dn_per_e, {.min = 1e-6, .max = 100});
    a("black_dn", black_dn, {.min = 0, .max = 200});
    a("read_noise_e", read_noise_e, {.min = 0, .max = 10000});
    a("dark_current_eps", dark_current_eps, {.min = 0, .max = 1e7});
    a("prnu_percent", prnu_percent, {.min = 0, .max = 20});
    a("dsnu_e", dsnu_e, {.min = 0, .max = 10000});
    a("hot_pixels_ppm", hot_pixels_ppm, {.min = 0, .max = 1e5});
    a("hot_current_eps", hot_current_eps, {.min = 0, .max = 1e9});
    a("reduction", reduction);
    a("factor", factor, {.min = 2, .max = 8});
    a("mosaic", mosaic);
  }
};

/// One sensor, with the pixels of its serial number.
class Sensor {
 public:
  /// @param pixels  columns and rows that are read out
  /// @param camera  0 left, 1 right: the two are different pieces
  Sensor(const SensorModel& model, cv::Size pixels, int camera);

  /// Exposes and reads out. Per pixel: photo-electrons and dark electrons are Poisson, the full well cuts
  /// them, then dark value, read noise, gain, black level, rounding, and the ends of the 8-bit range.
  /// Depends on (model, camera, level, setting, seed, frame) alone, pixel by pixel.
  /// @param level  CV_32FC1 of the sensor's size: mean light over the exposure, 255 is white
  /// @param grey   CV_8UC1, before the host bins
  void read_out(const cv::Mat& level, const ExposureSetting& setting, uint64_t seed, int64_t frame,
                cv::Mat& grey) const;

 private:
  struct Scale;
  struct Row;
  void draw(uint64_t key, int row, Row& r) const;
  void collect(const float* light, uint64_t key, int row, const Scale& scale, Row& r) const;
  void convert(int row, const Scale& scale, const Row& r, uchar* grey) const;

  const SensorModel model_;
  const cv::Size size_;
  const int camera_;
  cv::Mat sensitivity_;       ///< CV_32FC1: 1 on average
  cv::Mat dark_current_eps_;  ///< CV_32FC1
  cv::Mat dark_value_e_;      ///< CV_32FC1: 0 on average
};

/// n x n averages of a host, rounded.
cv::Mat binned(const cv::Mat& grey, int factor);

}  // namespace groundloop::sim
