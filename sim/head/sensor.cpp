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
constexpr float kMost_e = 1e9;  ///< far above any full well, and within an int

/// By value: the loops over a row take several pixels at a time then.
float higher(float a, float b) { return a > b ? a : b; }
float lower(float a, float b) { return a < b ? a : b; }

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

/// What one setting makes of light and charge, in the sensor's numbers.
struct Sensor::Scale {
  Scale(const SensorModel& model, const ExposureSetting& setting)
      : electrons_per_level(
            static_cast<float>(model.white_photons_per_s * model.quantum_efficiency * setting.time_s / 255)),
        time_s(static_cast<float>(setting.time_s)),
        gain(static_cast<float>(model.gain_dn_per_e * std::pow(10, setting.gain_db / 20))),
        full_well_e(static_cast<float>(model.full_well_e)),
        read_noise_e(static_cast<float>(model.read_noise_e)),
        black_dn(static_cast<float>(model.black_dn)) {}

  float electrons_per_level, time_s, gain, full_well_e, read_noise_e, black_dn;
};

/// Of one row.
struct Sensor::Row {
  explicit Row(size_t width) : shot(width), read(width), mean_e(width), collected_e(width) {}

  std::vector<float> shot, read;  ///< standard normal
  std::vector<float> mean_e, collected_e;
};

/// One word gives a pixel's two normal variables.
void Sensor::draw(uint64_t key, int row, Row& r) const {
  const auto& table = normal_quantiles();
  uint64_t word = key + kGolden * static_cast<uint64_t>(row) * static_cast<uint64_t>(size_.width);
  for (size_t i = 0; i < r.shot.size(); ++i) {
    const uint64_t bits = mix_word(word += kGolden);
    r.shot[i] = normal(bits, table);
    r.read[i] = normal(bits >> 32, table);
  }
}

/// Photo-electrons and dark electrons, Poisson. Where the mean is large, that is the quantile of the
/// distribution (Cornish and Fisher 1938) at a normal variable z; the spread is less by what the quadratic
/// term and the rounding to whole electrons add, 1/18 + 1/12.
void Sensor::collect(const float* light, uint64_t key, int row, const Scale& scale, Row& r) const {
  const float *sensitivity = sensitivity_.ptr<float>(row), *dark_eps = dark_current_eps_.ptr<float>(row);
  const float *z = r.shot.data(), per_level_e = scale.electrons_per_level, time_s = scale.time_s;
  float *mean_e = r.mean_e.data(), *collected_e = r.collected_e.data();
  const size_t width = r.mean_e.size();
  int small = 0;  // whether any mean is
  for (size_t i = 0; i < width; ++i) {
    const float wanted_e = higher(light[i], 0) * per_level_e * sensitivity[i] + dark_eps[i] * time_s;
    mean_e[i] = lower(wanted_e, kMost_e);
    small |= mean_e[i] < kLargeMean_e ? 1 : 0;
  }
  // z is within 5.2, so that no large mean has a count below 0; small ones are replaced below
  for (size_t i = 0; i < width; ++i) {
    const float spread = std::abs(mean_e[i] - 5.0F / 36);  // no branch
    const float count = mean_e[i] + std::sqrt(spread) * z[i] + (z[i] * z[i] - 1) * (1.0F / 6);
    collected_e[i] = static_cast<float>(static_cast<int>(count + 0.5F));
  }
  if (small == 0) return;
  const uint64_t before = static_cast<uint64_t>(row) * width;
  for (size_t i = 0; i < width; ++i) {
    if (mean_e[i] >= kLargeMean_e) continue;
    const uint64_t bits = mix_word((key ^ kSmallCounts) + kGolden * (before + i + 1));
    collected_e[i] = poisson_by_inversion(mean_e[i], uniform(bits));
  }
}

/// Full well, dark value, read noise, gain, black level, rounding.
void Sensor::convert(int row, const Scale& scale, const Row& r, uchar* grey) const {
  const float *dark_e = dark_value_e_.ptr<float>(row), *collected_e = r.collected_e.data(),
              *z = r.read.data();
  const float gain = scale.gain, full_well_e = scale.full_well_e, read_noise_e = scale.read_noise_e;
  const float rounding = scale.black_dn + 0.5F;
  const size_t width = r.collected_e.size();
  for (size_t i = 0; i < width; ++i) {
    const float electrons = lower(collected_e[i], full_well_e) + dark_e[i] + read_noise_e * z[i];
    grey[i] = static_cast<uchar>(static_cast<int>(lower(higher(electrons * gain + rounding, 0), 255)));
  }
}

void Sensor::read_out(const cv::Mat& level, const ExposureSetting& setting, uint64_t seed, int64_t frame,
                      cv::Mat& grey) const {
  CV_Assert(level.type() == CV_32FC1 && level.size() == size_);
  grey.create(size_, CV_8UC1);
  const uint64_t key = stream_key(seed, camera_, frame);
  const Scale scale(model_, setting);
  Row r(static_cast<size_t>(size_.width));
  for (int row = 0; row < size_.height; ++row) {
    draw(key, row, r);
    collect(level.ptr<float>(row), key, row, scale, r);
    convert(row, scale, r, grey.ptr(row));
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
