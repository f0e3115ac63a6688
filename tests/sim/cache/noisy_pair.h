#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "slam/types/counter_random.h"

namespace groundloop::sim {

/// A slanted grey ramp with noise of +-3 levels, as a sensor's: another one for every number.
inline cv::Mat noisy_image(cv::Size size, uint64_t number) {
  cv::Mat image(size, CV_8UC1);
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      const auto pixel = static_cast<uint64_t>(row * size.width + col);
      image.at<uint8_t>(row, col) = static_cast<uint8_t>(40 + (row + col) / 8 % 150 +
                                                         static_cast<int>(random_bits(number, 1, pixel) % 7));
    }
  }
  return image;
}

}  // namespace groundloop::sim
