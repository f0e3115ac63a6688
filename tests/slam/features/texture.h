#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/types/counter_random.h"

namespace groundloop::slam {

/// Uniform in [0, 1), a function of its keys alone.
inline double uniform(uint64_t seed, uint64_t stream, uint64_t counter) {
  return static_cast<double>(random_bits(seed, stream, counter) >> 11) * 0x1.0p-53;
}

/// Normal, mean 0, standard deviation 1 (Box and Muller).
inline double gaussian(uint64_t seed, uint64_t stream, uint64_t counter) {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(seed, 2 * stream, counter)));
  return radius * std::cos(2 * std::numbers::pi * uniform(seed, 2 * stream + 1, counter));
}

/// A smooth solid texture whose value is known exactly at every point of space: a sum of sine waves of random
/// directions. Pictures of it, however warped, have an exact answer.
class Texture {
 public:
  /// @param shortest, longest  wave lengths, in the units of the points
  Texture(uint64_t seed, double shortest, double longest, int waves = 24);

  /// Grey level, mean 128, standard deviation 35.
  double at(const Eigen::Vector3d& p) const;
  double at(double x, double y) const { return at({x, y, 0}); }

 private:
  struct Wave {
    Eigen::Vector3d k;
    double phase;
  };
  std::vector<Wave> waves_;
  double amplitude_;
};

/// What a camera adds to a picture.
struct Light {
  double gain = 1;
  double bias_grey = 0;
  double noise_grey = 0;
  uint64_t seed = 0;
};

/// 8-bit picture of grey(u, v), under a light.
template <class Grey>
cv::Mat draw(cv::Size size, const Light& light, Grey grey) {
  cv::Mat image(size, CV_8UC1);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      double value = light.gain * grey(u, v) + light.bias_grey;
      if (light.noise_grey > 0) {
        value += light.noise_grey * gaussian(light.seed, static_cast<uint64_t>(v), static_cast<uint64_t>(u));
      }
      image.at<uint8_t>(v, u) = cv::saturate_cast<uint8_t>(value);
    }
  }
  return image;
}

}  // namespace groundloop::slam
