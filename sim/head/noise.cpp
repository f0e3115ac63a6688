#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "sim/head/counter_noise.h"
#include "sim/head/head.h"

namespace groundloop::sim {

void apply_sensor_noise(const HeadNoise& noise, uint64_t seed, int camera, int64_t frame, cv::Mat& image) {
  CV_Assert(image.type() == CV_8UC1);
  std::array<float, 256> sigma{};
  for (int grey = 0; grey < 256; ++grey) {
    sigma[grey] =
        static_cast<float>(std::sqrt(noise.read_grey * noise.read_grey + noise.shot_grey_per_level * grey));
  }
  const std::array<float, kQuantiles>& normal = normal_quantiles();
  const uint64_t key = stream_key(seed, camera, frame);

  // One 64-bit word gives the noise of five pixels, 12 bits each.
  constexpr int kBlock = 5;
  const uint64_t blocks_per_row = (static_cast<uint64_t>(image.cols) + kBlock - 1) / kBlock;
  for (int row = 0; row < image.rows; ++row) {
    uchar* pixel = image.ptr(row);
    uint64_t counter = static_cast<uint64_t>(row) * blocks_per_row;
    for (int col = 0; col < image.cols; col += kBlock) {
      uint64_t bits = mix_word(key + kGolden * ++counter);
      const int end = std::min(col + kBlock, image.cols);
      for (int i = col; i < end; ++i, bits >>= kQuantileBits) {
        const float value = static_cast<float>(pixel[i]) + sigma[pixel[i]] * normal[bits % kQuantiles];
        pixel[i] = static_cast<uchar>(std::clamp(value + 0.5F, 0.0F, 255.0F));
      }
    }
  }
}

}  // namespace groundloop::sim
