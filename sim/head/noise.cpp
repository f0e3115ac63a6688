#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "sim/head/head.h"

namespace groundloop::sim {
namespace {

constexpr int kQuantiles = 1 << 12;

/// Standard normal quantile by bisection of erfc: slow, exact to double precision, run once for the table.
double normal_quantile(double probability) {
  double low = -10, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Equally likely values of a standard normal variable, scaled so that their variance is exactly 1.
const std::array<float, kQuantiles>& quantiles() {
  static const std::array<float, kQuantiles> table = [] {
    std::array<double, kQuantiles> exact{};
    double square_sum = 0;
    for (int i = 0; i < kQuantiles; ++i) {
      exact[i] = normal_quantile((i + 0.5) / kQuantiles);
      square_sum += exact[i] * exact[i];
    }
    std::array<float, kQuantiles> scaled{};
    for (int i = 0; i < kQuantiles; ++i) {
      scaled[i] = static_cast<float>(exact[i] / std::sqrt(square_sum / kQuantiles));
    }
    return scaled;
  }();
  return table;
}

/// Mixes 64 bits so that every input bit changes every output bit with probability 1/2 (Steele, Lea & Flood,
/// "Fast splittable pseudorandom number generators", OOPSLA 2014: the finaliser of SplitMix64).
constexpr uint64_t mix(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  x ^= x >> 31;
  return x;
}
constexpr uint64_t kGolden =
    0x9e3779b97f4a7c15ULL;  ///< odd, so that counter * kGolden visits all 64-bit values

uint64_t stream_key(uint64_t seed, int camera, int64_t frame) {
  uint64_t key = mix(seed + kGolden);
  key = mix(key ^ (static_cast<uint64_t>(camera) + kGolden));
  return mix(key ^ (static_cast<uint64_t>(frame) + kGolden));
}

}  // namespace

void apply_sensor_noise(const HeadNoise& noise, uint64_t seed, int camera, int64_t frame, cv::Mat& image) {
  CV_Assert(image.type() == CV_8UC1);
  std::array<float, 256> sigma{};
  for (int grey = 0; grey < 256; ++grey) {
    sigma[grey] =
        static_cast<float>(std::sqrt(noise.read_grey * noise.read_grey + noise.shot_grey_per_level * grey));
  }
  const std::array<float, kQuantiles>& normal = quantiles();
  const uint64_t key = stream_key(seed, camera, frame);

  // One 64-bit word gives the noise of five pixels, 12 bits each.
  constexpr int kBlock = 5;
  const uint64_t blocks_per_row = (static_cast<uint64_t>(image.cols) + kBlock - 1) / kBlock;
  for (int row = 0; row < image.rows; ++row) {
    uchar* pixel = image.ptr(row);
    uint64_t counter = static_cast<uint64_t>(row) * blocks_per_row;
    for (int col = 0; col < image.cols; col += kBlock) {
      uint64_t bits = mix(key + kGolden * ++counter);
      const int end = std::min(col + kBlock, image.cols);
      for (int i = col; i < end; ++i, bits >>= 12) {
        const float value = static_cast<float>(pixel[i]) + sigma[pixel[i]] * normal[bits % kQuantiles];
        pixel[i] = static_cast<uchar>(std::clamp(value + 0.5F, 0.0F, 255.0F));
      }
    }
  }
}

}  // namespace groundloop::sim
