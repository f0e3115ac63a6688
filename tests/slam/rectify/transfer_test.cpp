#include "slam/rectify/transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/head/pixel_grid.h"
#include "sim/head/transfer.h"

namespace groundloop::slam {
namespace {

TEST(Transfer, WhatTheSimulatorSendsIsReadAgain) {
  cv::Mat left(48, 64, CV_8UC1), right(48, 64, CV_8UC1);
  cv::randu(left, 0, 256);
  cv::randu(right, 0, 256);
  const std::vector<uint8_t> bytes = sim::interleaved(left, right);
  ASSERT_EQ(bytes.size(), 2U * 48 * 64);
  EXPECT_EQ(bytes[0], right.at<uchar>(0, 0)) << "the right camera's byte comes first";
  EXPECT_EQ(bytes[1], left.at<uchar>(0, 0));
  cv::Mat read_left, read_right;
  deinterleave(bytes, left.size(), FirstByte::kRight, read_left, read_right);
  EXPECT_EQ(cv::norm(read_left, left, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(read_right, right, cv::NORM_INF), 0);
  deinterleave(bytes, left.size(), FirstByte::kLeft, read_left, read_right);
  EXPECT_EQ(cv::norm(read_left, right, cv::NORM_INF), 0);
}

TEST(Transfer, AShortPairIsRefused) {
  const std::vector<uint8_t> bytes(100);
  cv::Mat left, right;
  try {
    deinterleave(bytes, {8, 8}, FirstByte::kRight, left, right);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "a pair of 100 bytes; 8x8 has 128");
  }
}

TEST(Transfer, GreyOfAMosaicIsItsColoursLuma) {
  const std::array<double, 3> bgr = {40, 90, 200};
  const double luma = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
  for (const auto& [filter, mosaic] : {std::pair(ColourFilter::kRggb, sim::Mosaic::kRggb),
                                       std::pair(ColourFilter::kGrbg, sim::Mosaic::kGrbg),
                                       std::pair(ColourFilter::kGbrg, sim::Mosaic::kGbrg),
                                       std::pair(ColourFilter::kBggr, sim::Mosaic::kBggr)}) {
    cv::Mat image(16, 16, CV_8UC1);
    for (int v = 0; v < 16; ++v) {
      for (int u = 0; u < 16; ++u) {
        image.at<uchar>(v, u) =
            cv::saturate_cast<uchar>(bgr[static_cast<size_t>(sim::channel_of(mosaic, v, u))]);
      }
    }
    mosaic_to_grey(filter, image);
    EXPECT_NEAR(cv::mean(image)[0], luma, 1) << static_cast<int>(filter);
    EXPECT_EQ(image.type(), CV_8UC1);
  }
  cv::Mat plain(4, 4, CV_8UC1, 7);
  mosaic_to_grey(ColourFilter::kNone, plain);
  EXPECT_EQ(plain.at<uchar>(2, 2), 7);
}

}  // namespace
}  // namespace groundloop::slam
