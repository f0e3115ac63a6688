#include "sim/head/sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "sim/head/counter_noise.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kPixelPattern = 0x7061747465726e;  ///< streams of a serial number
constexpr int64_t kSensitivity = 0, kDarkValue = 1, kHot = 2;
constexpr uint64_t kSmallCounts = 0x736d616c6c;  ///< stream of the exact draws in the dark
/// From here on a Poisson variable is drawn by the expansion of its quantile, below by inversion.
constexpr float kLargeMean_e = 16;

double uniform(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Standard normal from 24 bits: two table values, so that the tails reach 5 standard deviations.
float normal(uint64_t bits, const std::array<float, kQuantiles>& table) {
  return 0.70710678F * (table[bits % kQuantiles] + table[(bits >> kQuantileBits) % kQuantiles]);
}

/// Counts with a small mean, by inversion of the distribution function.
float poisson_by_inversion(double mean, double probability) {
  double term = std::exp(-mean), sum = term;
  int count = 0;
  while (sum < probability && term > 1e-18) {
    term *= mean / ++count;
    sum += term;
  }
  return static_cast<float>(count);
}

}  // namespace

Sensor::Sensor(const SensorModel& model, cv::Size pixels, int camera)
    : model_(model),
      size_(pixels),
      camera_(camera),
      sensitivity_(pixels, CV_32FC1),
      dark_current_eps_(pixels, CV_32FC1),
      dark_value_e_(pixels, CV_32FC1) {
  const auto& table = normal_quantiles();
  const auto key = [&](int64_t what) {
    return stream_key(static_cast<uint64_t>(model.serial) ^ kPixelPattern, camera, what);
  };
  const uint64_t sensitivity_key = key(kSensitivity), dark_key = key(kDarkValue), hot_key = key(kHot);
  for (int i = 0; i < pixels.area(); ++i) {
    const uint64_t step = kGolden * (static_cast<uint64_t>(i) + 1);
    const float sensitivity =
        1 + static_cast<float>(model.prnu_percent / 100) * normal(mix_word(sensitivity_key + step), table);
    const bool hot = uniform(mix_word(hot_key + step)) < model.hot_pixels_ppm * 1e-6;
    sensitivity_.ptr<float>()[i] = std::max(0.0F, sensitivity);
    dark_value_e_.ptr<float>()[i] =
        static_cast<float>(model.dsnu_e) * normal(mix_word(dark_key + step), table);
    dark_current_eps_.ptr<float>()[i] =
        static_cast<float>(hot ? model.hot_current_eps : model.dark_current_eps);
  }
}

/// One word gives a pixel's two normal variables.
void Sensor::draw(uint64_t key, int row, Noise& noise) const {
  const auto& table = normal_quantiles();
  uint64_t word = key + kGolden * static_cast<uint64_t>(row) * static_cast<uint64_t>(size_.width);
  for (size_t i = 0; i < noise.shot.size(); ++i) {
    const uint64_t bits = mix_word(word += kGolden);
    noise.shot[i] = normal(bits, table);
    noise.read[i] = normal(bits >> 32, table);
  }
}

void Sensor::read_out(const cv::Mat& level, const ExposureSetting& setting, uint64_t seed, int64_t frame,
                      cv::Mat& grey) const {
  CV_Assert(level.type() == CV_32FC1 && level.size() == size_);
  grey.create(size_, CV_8UC1);
  const uint64_t key = stream_key(seed, camera_, frame), small_key = key ^ kSmallCounts;
  const auto time_s = static_cast<float>(setting.time_s);
  const auto electrons_per_level =
      static_cast<float>(model_.white_photons_per_s * model_.quantum_efficiency * setting.time_s / 255);
  const auto gain = static_cast<float>(model_.gain_dn_per_e * std::pow(10, setting.gain_db / 20));
  const auto full_well = static_cast<float>(model_.full_well_e);
  const auto read_noise = static_cast<float>(model_.read_noise_e);
  const float black = static_cast<float>(model_.black_dn) + 0.5F;  // for rounding by truncation

  const auto width = static_cast<size_t>(size_.width);
  Noise noise{std::vector<float>(width), std::vector<float>(width)};
  std::vector<float> mean(width), collected(width);
  for (int row = 0; row < size_.height; ++row) {
    draw(key, row, noise);
    const float *light = level.ptr<float>(row), *sensitivity = sensitivity_.ptr<float>(row);
    const float *dark_eps = dark_current_eps_.ptr<float>(row), *dark_e = dark_value_e_.ptr<float>(row);
    float darkest = kLargeMean_e;
    for (size_t i = 0; i < width; ++i) {
      mean[i] = std::max(0.0F, light[i]) * electrons_per_level * sensitivity[i] + dark_eps[i] * time_s;
      darkest = std::min(darkest, mean[i]);
    }
    // Quantile of the Poisson distribution (Cornish and Fisher 1938) at the normal variable z. The spread is
    // less by what the quadratic term and the rounding to whole electrons add, 1/18 + 1/12.
    for (size_t i = 0; i < width; ++i) {
      const float z = noise.shot[i], spread = std::max(0.0F, mean[i] - 5.0F / 36);
      const float count = mean[i] + std::sqrt(spread) * z + (z * z - 1) * (1.0F / 6);
      collected[i] = static_cast<float>(static_cast<int>(std::min(std::max(0.0F, count + 0.5F), 2e9F)));
    }
    if (darkest < kLargeMean_e) {
      const uint64_t first = static_cast<uint64_t>(row) * width;
      for (size_t i = 0; i < width; ++i) {
        if (mean[i] >= kLargeMean_e) continue;
        collected[i] =
            poisson_by_inversion(mean[i], uniform(mix_word(small_key + kGolden * (first + i + 1))));
      }
    }
    uchar* out = grey.ptr(row);
    for (size_t i = 0; i < width; ++i) {
      const float electrons = std::min(collected[i], full_well) + dark_e[i] + read_noise * noise.read[i];
      const float value = electrons * gain + black;
      out[i] = static_cast<uchar>(static_cast<int>(std::min(std::max(value, 0.0F), 255.0F)));
    }
  }
}

cv::Mat binned(const cv::Mat& grey, int factor) {
  cv::Mat result(grey.rows / factor, grey.cols / factor, CV_8UC1);
  for (int row = 0; row < result.rows; ++row) {
    for (int col = 0; col < result.cols; ++col) {
      int sum = factor * factor / 2;
      for (int v = 0; v < factor; ++v) {
        const uchar* from = grey.ptr(row * factor + v) + static_cast<ptrdiff_t>(col) * factor;
        for (int u = 0; u < factor; ++u) sum += from[u];
      }
      result.at<uchar>(row, col) = static_cast<uchar>(sum / (factor * factor));
    }
  }
  return result;
}

}  // namespace groundloop::sim
