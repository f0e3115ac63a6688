#include "slam/features/image_pyramid.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr int kScale = ImagePyramid::kScale;

int at(const cv::Mat& level, int u, int v) { return level.at<int16_t>(v, u); }

TEST(ImagePyramid, AConstantImageStaysItselfTimesTheScale) {
  const cv::Mat grey(64, 96, CV_8UC1, cv::Scalar(200));
  ImagePyramid pyramid;
  pyramid.build(grey, 3);
  for (int l = 0; l < 3; ++l) {
    double least, most;
    cv::minMaxLoc(pyramid.level(l), &least, &most);
    EXPECT_EQ(least, 200 * kScale) << "level " << l;
    EXPECT_EQ(most, 200 * kScale) << "level " << l;
  }
}

TEST(ImagePyramid, LevelsHalveAndRoundUp) {
  ImagePyramid pyramid;
  pyramid.build(cv::Mat::zeros(121, 161, CV_8UC1), 4);
  ASSERT_EQ(pyramid.levels(), 4);
  const cv::Size sizes[] = {{161, 121}, {81, 61}, {41, 31}, {21, 16}};
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(pyramid.level(l).size(), sizes[l]);
    EXPECT_EQ(pyramid.level(l).type(), CV_16SC1);
  }
  pyramid.build(cv::Mat::zeros(64, 64, CV_8UC1), 2);  // storage is used again
  EXPECT_EQ(pyramid.levels(), 2);
  EXPECT_EQ(pyramid.level(1).size(), cv::Size(32, 32));
}

TEST(ImagePyramid, APointIsSpreadByTheBinomialWithoutLoss) {
  cv::Mat grey = cv::Mat::zeros(48, 48, CV_8UC1);
  grey.at<uint8_t>(20, 24) = 255;
  ImagePyramid pyramid;
  pyramid.build(grey, 2);
  const int weights[3] = {1, 2, 1};
  for (int v = 16; v <= 24; ++v) {
    for (int u = 20; u <= 28; ++u) {
      const int dv = v - 20, du = u - 24;
      const bool near = std::abs(dv) <= 1 && std::abs(du) <= 1;
      EXPECT_EQ(at(pyramid.level(0), u, v), near ? 255 * weights[dv + 1] * weights[du + 1] : 0);
    }
  }
  // Level 1 has it at (12, 10): half the coordinates, and a quarter of the light.
  double most;
  cv::Point where;
  cv::minMaxLoc(pyramid.level(1), nullptr, &most, nullptr, &where);
  EXPECT_EQ(where, cv::Point(12, 10));
  EXPECT_NEAR(cv::sum(pyramid.level(1))[0], 255.0 * kScale / 4, 10);
}

TEST(ImagePyramid, ARampKeepsItsValueAtHalfTheCoordinates) {
  cv::Mat grey(80, 100, CV_8UC1);
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) grey.at<uint8_t>(v, u) = static_cast<uint8_t>(u + v);
  }
  ImagePyramid pyramid;
  pyramid.build(grey, 3);
  for (int l = 0; l < 3; ++l) {
    const int factor = 1 << l;
    for (int v = 5; v < 15; ++v) {
      for (int u = 5; u < 20; ++u) EXPECT_EQ(at(pyramid.level(l), u, v), kScale * factor * (u + v));
    }
  }
}

TEST(ImagePyramid, BordersRepeatTheLastPixel) {
  cv::Mat grey = cv::Mat::zeros(32, 32, CV_8UC1);
  grey.at<uint8_t>(0, 0) = 100;
  ImagePyramid pyramid;
  pyramid.build(grey, 1);
  EXPECT_EQ(at(pyramid.level(0), 0, 0), 9 * 100);  // (1 + 2) x (1 + 2) of 16
  EXPECT_EQ(at(pyramid.level(0), 1, 0), 3 * 100);
  EXPECT_EQ(at(pyramid.level(0), 1, 1), 100);
}

TEST(ImagePyramid, SwapExchangesTheLevels) {
  ImagePyramid a, b;
  a.build(cv::Mat::ones(32, 32, CV_8UC1), 2);
  b.build(cv::Mat::zeros(64, 64, CV_8UC1), 1);
  a.swap(b);
  EXPECT_EQ(a.levels(), 1);
  EXPECT_EQ(b.levels(), 2);
  EXPECT_EQ(at(b.level(0), 9, 9), kScale);
}

}  // namespace
}  // namespace groundloop::slam
