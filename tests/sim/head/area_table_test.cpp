#include "sim/head/area_table.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/core.hpp>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

constexpr float kExact = 255.0F / (1 << 12);  ///< a few weights, each rounded to 2^-14

std::vector<float> ones(int n) { return std::vector<float>(static_cast<size_t>(n), 1.0F); }

float resampled(const cv::Mat& image, const Footprint& footprint) {
  AreaTable table(image.size());
  table.add(footprint, 0);
  cv::Mat output(1, 1, CV_32FC1);
  table.apply(image, ones(1), output);
  return output.at<float>(0);
}

/// Grey = 2 x + 3 y.
cv::Mat ramp() {
  cv::Mat image(40, 48, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) image.at<uchar>(y, x) = static_cast<uchar>(2 * x + 3 * y);
  }
  return image;
}

Footprint box(double left, double top, double right, double bottom) {
  return {Vector2d(left, top), {right, top}, {right, bottom}, {left, bottom}};
}

TEST(AreaTable, WeighsByTheSharedArea) {
  cv::Mat image = cv::Mat::zeros(8, 8, CV_8UC1);
  image.at<uchar>(3, 4) = 200;
  // pixel (4, 3) covers [3.5, 4.5] x [2.5, 3.5]; the box of 2 x 1.5 shares 0.75 x 0.5 of it
  EXPECT_NEAR(resampled(image, box(1.75, 3.0, 3.75 + 0.5, 4.5)), 200 * 0.75 * 0.5 / (2.5 * 1.5), kExact);
  // one corner: a triangle with legs of 1
  const Footprint diamond = {Vector2d(3.5, 1.5), {4.5, 2.5}, {3.5, 3.5}, {2.5, 2.5}};
  EXPECT_NEAR(resampled(image, diamond), 200 * 0.5 / 2, kExact);
}

TEST(AreaTable, AnEvenImageStaysEvenAndARampIsReadAtTheCentroid) {
  const cv::Mat even(40, 48, CV_8UC1, cv::Scalar(137));
  const Footprint skewed = {Vector2d(20.3, 10.2), {23.1, 11.4}, {22.2, 13.7}, {19.4, 12.5}};  // parallelogram
  const Vector2d centre = 0.25 * (skewed[0] + skewed[1] + skewed[2] + skewed[3]);
  EXPECT_EQ(resampled(even, skewed), 137);
  // a ramp over pixels has steps: its mean over a part of a pixel is that of the pixel. The footprint's steps
  // cancel to a few hundredths.
  EXPECT_NEAR(resampled(ramp(), skewed), 2 * centre.x() + 3 * centre.y(), 0.2);
  EXPECT_NEAR(resampled(ramp(), box(9.5, 5.5, 13.5, 8.5)), 2 * 11.5 + 3 * 7, kExact);
}

/// Footprints that tile a part of the image share out its light without loss.
TEST(AreaTable, TilesShareOutTheLight) {
  cv::Mat image(40, 48, CV_8UC1);
  cv::randu(image, 0, 256);
  const auto bent = [](double i, double j) {  // a smooth bend that keeps the outline
    const double x = 8 + 2.9 * i, y = 6 + 2.3 * j;
    const double bulge = 0.7 * std::sin(M_PI * i / 10) * std::sin(M_PI * j / 10);
    return Vector2d(x + bulge - 0.5, y - 1.3 * bulge - 0.5);
  };
  AreaTable table(image.size());
  std::vector<double> areas;
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      const Footprint f = {bent(i, j), bent(i + 1, j), bent(i + 1, j + 1), bent(i, j + 1)};
      table.add(f, 0);
      const Vector2d a = f[2] - f[0], b = f[3] - f[1];
      areas.push_back(0.5 * std::abs(a.x() * b.y() - a.y() * b.x()));
    }
  }
  cv::Mat output(10, 10, CV_32FC1);
  table.apply(image, ones(100), output);
  double light = 0;
  for (int i = 0; i < 100; ++i) light += areas[static_cast<size_t>(i)] * output.ptr<float>()[i];
  EXPECT_NEAR(light, 29.0 * 23 * resampled(image, box(7.5, 5.5, 36.5, 28.5)), 29 * 23 * 0.05);
}

TEST(AreaTable, ReadsTheChannelAsked) {
  const cv::Mat image(8, 8, CV_8UC3, cv::Scalar(10, 60, 250));
  AreaTable table(image.size());
  for (const int channel : {0, 1, 2}) table.add(box(2.2, 2.2, 4.9, 4.1), channel);
  cv::Mat output(1, 3, CV_32FC1);
  table.apply(image, {1, 1, 0.5}, output);
  EXPECT_EQ(output.at<float>(0), 10);
  EXPECT_EQ(output.at<float>(1), 60);
  EXPECT_EQ(output.at<float>(2), 125);
}

TEST(AreaTable, ReachesTheEdgesButNotBeyond) {
  const cv::Mat even(8, 8, CV_8UC1, cv::Scalar(200));
  EXPECT_EQ(resampled(even, box(-0.5, -0.5, 7.5, 7.5)), 200);
  EXPECT_EQ(resampled(even, box(6.9, 6.9, 7.5, 7.5)), 200);
  AreaTable table(even.size());
  EXPECT_THROW(table.add(box(6.9, 6.9, 7.6, 7.5), 0), std::invalid_argument);
  EXPECT_THROW(table.add(box(3, 3, 3, 4), 0), std::invalid_argument);
}

}  // namespace
}  // namespace groundloop::sim
