#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/head/head.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kSeed = 17;

cv::Mat noisy(int grey, int camera, int64_t frame, const HeadNoise& noise, uint64_t seed = kSeed) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(grey));
  apply_sensor_noise(noise, seed, camera, frame, image);
  return image;
}

struct Moments {
  double mean, variance;
};

Moments moments(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  return {mean[0], deviation[0] * deviation[0]};
}

double correlation(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat da, db;
  a.convertTo(da, CV_64F, 1, -cv::mean(a)[0]);
  b.convertTo(db, CV_64F, 1, -cv::mean(b)[0]);
  return da.dot(db) / std::sqrt(da.dot(da) * db.dot(db));
}

TEST(Noise, MeanAndVarianceAsConfigured) {
  const HeadNoise noise{.read_grey = 1.5, .shot_grey_per_level = 0.05};
  for (const int grey : {20, 60, 128, 200, 235}) {
    const Moments m = moments(noisy(grey, 0, 3, noise));
    // Rounding to whole grey values adds 1/12.
    const double variance = 1.5 * 1.5 + 0.05 * grey + 1.0 / 12;
    const double pixels = 640 * 480;
    EXPECT_NEAR(m.mean, grey, 5 * std::sqrt(variance / pixels)) << grey;
    EXPECT_NEAR(m.variance, variance, 5 * variance * std::sqrt(2 / pixels)) << grey;
  }
}

TEST(Noise, GaussianTails) {
  const cv::Mat image = noisy(128, 0, 0, {.read_grey = 10, .shot_grey_per_level = 0});
  for (const int sigmas : {1, 2, 3}) {
    const cv::Mat beyond = (image > 128 + 10 * sigmas) | (image < 128 - 10 * sigmas);
    const double limit = sigmas + 0.05;  // grey values are rounded
    EXPECT_NEAR(cv::countNonZero(beyond) / (640.0 * 480.0), std::erfc(limit / std::sqrt(2.0)), 0.002)
        << sigmas;
  }
}

TEST(Noise, ZeroNoiseChangesNothing) {
  EXPECT_EQ(cv::norm(noisy(77, 0, 0, {.read_grey = 0, .shot_grey_per_level = 0}),
                     cv::Mat(480, 640, CV_8UC1, 77), cv::NORM_INF),
            0);
}

TEST(Noise, ClampsAtTheEndsOfTheRange) {
  const HeadNoise noise{.read_grey = 20, .shot_grey_per_level = 0};
  double low, high;
  cv::minMaxLoc(noisy(250, 0, 0, noise), &low, &high);
  EXPECT_EQ(high, 255);
  EXPECT_GT(low, 150);  // nothing wrapped around
  cv::minMaxLoc(noisy(3, 0, 0, noise), &low, &high);
  EXPECT_EQ(low, 0);
  EXPECT_LT(high, 105);
}

TEST(Noise, CamerasFramesAndSeedsAreIndependent) {
  const HeadNoise noise{.read_grey = 4, .shot_grey_per_level = 0};
  const cv::Mat image = noisy(128, 0, 10, noise);
  const double limit = 5 / std::sqrt(640.0 * 480.0);
  EXPECT_LT(std::abs(correlation(image, noisy(128, 1, 10, noise))), limit);
  EXPECT_LT(std::abs(correlation(image, noisy(128, 0, 11, noise))), limit);
  EXPECT_LT(std::abs(correlation(image, noisy(128, 1, 9, noise))), limit);
  EXPECT_LT(std::abs(correlation(image, noisy(128, 0, 10, noise, kSeed + 1))), limit);
}

TEST(Noise, NeighbouringPixelsAreIndependent) {
  const cv::Mat image = noisy(128, 0, 10, {.read_grey = 4, .shot_grey_per_level = 0});
  const double limit = 5 / std::sqrt(640.0 * 480.0);
  for (const int shift : {1, 2, 3, 4, 5, 6, 7, 64}) {
    EXPECT_LT(std::abs(correlation(image.colRange(0, 640 - shift), image.colRange(shift, 640))), limit)
        << shift;
    EXPECT_LT(std::abs(correlation(image.rowRange(0, 480 - shift), image.rowRange(shift, 480))), limit)
        << shift;
  }
}

TEST(Noise, AnyFrameCanBeMadeAlone) {
  const HeadNoise noise;
  std::vector<cv::Mat> sequence;
  for (int64_t frame = 0; frame < 5; ++frame) sequence.push_back(noisy(90, 0, frame, noise));
  EXPECT_EQ(cv::norm(noisy(90, 0, 3, noise), sequence[3], cv::NORM_INF), 0);
}

TEST(Noise, PixelDependsOnItsPlaceOnly) {
  // Other grey values elsewhere in the image leave a pixel's noise alone.
  const HeadNoise noise{.read_grey = 5, .shot_grey_per_level = 0};
  cv::Mat half(480, 640, CV_8UC1, cv::Scalar(128));
  half.colRange(0, 320) = 30;
  apply_sensor_noise(noise, kSeed, 0, 0, half);
  EXPECT_EQ(cv::norm(half.colRange(320, 640), noisy(128, 0, 0, noise).colRange(320, 640), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace groundloop::sim
