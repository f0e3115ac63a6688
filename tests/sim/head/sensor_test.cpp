#include "sim/head/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace groundloop::sim {
namespace {

constexpr uint64_t kSeed = 5;
const cv::Size kSize(400, 300);
constexpr double kPixels = 400.0 * 300.0;

/// One electron is one grey level; only shot noise.
SensorModel counter() {
  SensorModel model;
  model.quantum_efficiency = 0.5;
  model.gain_dn_per_e = 1;
  model.full_well_e = 1e6;
  model.read_noise_e = model.dark_current_eps = model.prnu_percent = model.dsnu_e = model.hot_pixels_ppm = 0;
  return model;
}

cv::Mat image(const SensorModel& model, double level, const ExposureSetting& setting = {0.01, 0},
              int64_t frame = 0, int camera = 0, uint64_t seed = kSeed) {
  cv::Mat grey;
  Sensor(model, kSize, camera)
      .read_out(cv::Mat(kSize, CV_32FC1, cv::Scalar(level)), setting, seed, frame, grey);
  return grey;
}

/// The level at which `electrons` are collected on average.
double level_of(const SensorModel& model, double electrons, double time_s = 0.01) {
  return 255 * electrons / (model.white_photons_per_s * time_s * model.quantum_efficiency);
}

struct Moments {
  double mean, variance, skew;  ///< skew: third central moment
};
Moments moments(const cv::Mat& grey) {
  cv::Mat x;
  grey.convertTo(x, CV_64F);
  const double mean = cv::mean(x)[0];
  x -= mean;
  const cv::Mat x2 = x.mul(x), x3 = x2.mul(x);
  return {mean, cv::mean(x2)[0], cv::mean(x3)[0]};
}

double correlation(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat da, db;
  a.convertTo(da, CV_64F, 1, -cv::mean(a)[0]);
  b.convertTo(db, CV_64F, 1, -cv::mean(b)[0]);
  return da.dot(db) / std::sqrt(da.dot(da) * db.dot(db));
}

/// Mean, variance and third moment of a Poisson variable are one number.
TEST(Sensor, ElectronsArePoisson) {
  const SensorModel model = counter();
  for (const double electrons : {0.3, 2.0, 7.5, 15.9, 16.1, 30.0, 64.0, 150.0}) {
    const Moments m = moments(image(model, level_of(model, electrons)));
    EXPECT_NEAR(m.mean, electrons, 5 * std::sqrt(electrons / kPixels)) << electrons;
    const double fourth = electrons + 3 * electrons * electrons;
    EXPECT_NEAR(m.variance, electrons, 5 * std::sqrt((fourth - electrons * electrons) / kPixels))
        << electrons;
    EXPECT_NEAR(m.skew, electrons, 5 * std::sqrt(15 * std::pow(electrons + 1, 3) / kPixels)) << electrons;
  }
}

TEST(Sensor, SmallCountsHaveTheirExactShares) {
  const SensorModel model = counter();
  const cv::Mat grey = image(model, level_of(model, 1.5));
  double share = std::exp(-1.5);
  for (int count = 0; count < 6; ++count) {
    EXPECT_NEAR(cv::countNonZero(grey == count) / kPixels, share, 5 * std::sqrt(share / kPixels)) << count;
    share *= 1.5 / (count + 1);
  }
}

TEST(Sensor, LightTimeAndQuantumEfficiencyGiveTheElectronsAndGainTheGreyValue) {
  SensorModel model = counter();
  model.white_photons_per_s = 2e6;
  model.quantum_efficiency = 0.4;
  model.gain_dn_per_e = 0.01;
  model.black_dn = 7;
  // 128/255 of 2e6 / s over 12 ms: 12047 photons, 4819 electrons, 48.19 grey levels; 6.02 dB are twice that
  const double electrons = 2e6 * 0.012 * 0.4 * 128 / 255;
  EXPECT_NEAR(moments(image(model, 128, {0.012, 0})).mean, 7 + 0.01 * electrons, 0.02);
  EXPECT_NEAR(moments(image(model, 128, {0.012, 20 * std::log10(2)})).mean, 7 + 0.02 * electrons, 0.02);
  EXPECT_NEAR(moments(image(model, 128, {0.006, 0})).mean, 7 + 0.005 * electrons, 0.02);
}

TEST(Sensor, FullWellEndsTheLight) {
  SensorModel model = counter();
  model.full_well_e = 180;
  EXPECT_EQ(
      cv::norm(image(model, level_of(model, 1000)), cv::Mat(kSize, CV_8UC1, cv::Scalar(180)), cv::NORM_INF),
      0);
  model.full_well_e = 1e6;
  EXPECT_EQ(
      cv::norm(image(model, level_of(model, 1000)), cv::Mat(kSize, CV_8UC1, cv::Scalar(255)), cv::NORM_INF),
      0);
}

TEST(Sensor, DarkCurrentGrowsWithTimeAndHotPixelsStandOut) {
  SensorModel model = counter();
  model.dark_current_eps = 2000;
  EXPECT_NEAR(moments(image(model, 0, {0.01, 0})).mean, 20, 0.1);
  const Moments longer = moments(image(model, 0, {0.03, 0}));
  EXPECT_NEAR(longer.mean, 60, 0.15);
  EXPECT_NEAR(longer.variance, 60, 1.5);  // with its own shot noise
  model.hot_pixels_ppm = 1000;
  model.hot_current_eps = 20000;
  const cv::Mat hot = image(model, 0, {0.01, 0}) > 100;
  EXPECT_NEAR(cv::countNonZero(hot), 1e-3 * kPixels, 5 * std::sqrt(1e-3 * kPixels));
  EXPECT_EQ(cv::norm(hot, image(model, 0, {0.01, 0}, 9) > 100, cv::NORM_INF), 0)
      << "they stay where they are";
}

TEST(Sensor, ThePatternHangsOnSerialAndCameraOnly) {
  SensorModel model = counter();
  model.prnu_percent = 10;
  model.white_photons_per_s = 1e8;
  model.gain_dn_per_e = 1e-3;
  model.full_well_e = 1e7;
  const double level = level_of(model, 1.2e5);
  const cv::Mat one = image(model, level), later = image(model, level, {0.01, 0}, 7, 0, kSeed + 1);
  EXPECT_GT(correlation(one, later), 0.98);
  const double limit = 5 / std::sqrt(kPixels);
  EXPECT_LT(std::abs(correlation(one, image(model, level, {0.01, 0}, 0, 1))), limit);
  model.serial = 2;
  EXPECT_LT(std::abs(correlation(one, image(model, level))), limit);
}

TEST(Sensor, NoiseIsNewInEveryFrameCameraSeedAndPixel) {
  SensorModel model = counter();
  const double level = level_of(model, 90);
  const cv::Mat one = image(model, level);
  const double limit = 5 / std::sqrt(kPixels);
  EXPECT_LT(std::abs(correlation(one, image(model, level, {0.01, 0}, 1))), limit);
  EXPECT_LT(std::abs(correlation(one, image(model, level, {0.01, 0}, 0, 1))), limit);
  EXPECT_LT(std::abs(correlation(one, image(model, level, {0.01, 0}, 0, 0, kSeed + 1))), limit);
  for (const int shift : {1, 2, 3, 5}) {
    EXPECT_LT(std::abs(correlation(one.colRange(0, 400 - shift), one.colRange(shift, 400))), limit) << shift;
    EXPECT_LT(std::abs(correlation(one.rowRange(0, 300 - shift), one.rowRange(shift, 300))), limit) << shift;
  }
  // any frame can be made again alone
  EXPECT_EQ(cv::norm(one, image(model, level), cv::NORM_INF), 0);
}

TEST(Sensor, HostBinningRoundsTheMean) {
  const cv::Mat grey = (cv::Mat_<uchar>(2, 4) << 1, 2, 255, 255, 3, 4, 255, 254);
  const cv::Mat small = binned(grey, 2);
  ASSERT_EQ(small.size(), cv::Size(2, 1));
  EXPECT_EQ(small.at<uchar>(0, 0), 3);  // 2.5, rounded up
  EXPECT_EQ(small.at<uchar>(0, 1), 255);
}

}  // namespace
}  // namespace groundloop::sim
