#include "slam/features/corner_response.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

/// Largest difference from OpenCV's where the window is inside, relative to its strongest response.
double largest_difference(const cv::Mat& grey, const cv::Mat& response) {
  cv::Mat expected;
  cv::cornerMinEigenVal(grey, expected, 5, 3);
  constexpr int kReach = CornerResponse::kReach_px;
  const cv::Rect inside(kReach, kReach, grey.cols - 2 * kReach, grey.rows - 2 * kReach);
  return cv::norm(response(inside), expected(inside), cv::NORM_INF) /
         cv::norm(expected(inside), cv::NORM_INF);
}

cv::Mat textured(cv::Size size, int seed) {
  const Texture texture(seed, 8, 60);
  return draw(size, {}, [&](int u, int v) { return texture.at(u, v); });
}

TEST(CornerResponse, IsThatOfOpenCvOnImagesOfAnySize) {
  CornerResponse response;
  for (const cv::Size size : {cv::Size(320, 240), cv::Size(333, 111), cv::Size(9, 40), cv::Size(641, 7)}) {
    const cv::Mat grey = textured(size, size.width);
    EXPECT_LT(largest_difference(grey, response.compute(grey)), 1e-5) << size;
  }
}

TEST(CornerResponse, HoldsTheStrongestGradients) {
  cv::Mat board(64, 64, CV_8UC1);
  for (int v = 0; v < 64; ++v)
    for (int u = 0; u < 64; ++u) board.at<uint8_t>(v, u) = (u / 3 + v / 3) % 2 == 0 ? 0 : 255;
  CornerResponse response;
  EXPECT_LT(largest_difference(board, response.compute(board)), 1e-5);
}

TEST(CornerResponse, ReadsAPartOfALargerImage) {
  const cv::Mat part = textured({200, 150}, 3)(cv::Rect(17, 11, 101, 77));
  CornerResponse response;
  EXPECT_LT(largest_difference(part, response.compute(part)), 1e-5);
}

TEST(CornerResponse, IsZeroWhereTheWindowLeavesTheImage) {
  CornerResponse response;
  cv::Mat border = response.compute(textured({60, 50}, 9)).clone();
  ASSERT_EQ(border.size(), cv::Size(60, 50));
  border(cv::Rect(3, 3, 54, 44)).setTo(0);
  EXPECT_EQ(cv::countNonZero(border), 0);
  EXPECT_EQ(cv::countNonZero(response.compute(textured({6, 50}, 9))), 0);
}

}  // namespace
}  // namespace groundloop::slam
