#include "slam/pipeline/repeated_pair.h"

#include <gtest/gtest.h>

namespace groundloop::slam {
namespace {

class RepeatedPairTest : public testing::Test {
 protected:
  RepeatedPairTest() {
    frame_.left = cv::Mat(12, 16, CV_8UC1, cv::Scalar(40));
    frame_.right = cv::Mat(12, 16, CV_8UC1, cv::Scalar(50));
    frame_.T_previous_left = Pose(Eigen::Translation3d(0, 0, 0.04));
  }

  StereoFrame frame_;
  RepeatedPair repeated_;
};

TEST_F(RepeatedPairTest, IsToldByEveryByteOfBothImages) {
  EXPECT_FALSE(repeated_.is(frame_)) << "the first";
  EXPECT_TRUE(repeated_.is(frame_));
  EXPECT_TRUE(repeated_.is(frame_));
  frame_.left.at<uint8_t>(11, 15) = 41;
  EXPECT_FALSE(repeated_.is(frame_));
  EXPECT_TRUE(repeated_.is(frame_));
  frame_.right.at<uint8_t>(0, 0) = 51;
  EXPECT_FALSE(repeated_.is(frame_)) << "written into the same buffer";
  EXPECT_TRUE(repeated_.is(frame_));
}

TEST_F(RepeatedPairTest, WhatStandsStillMayLookTheSame) {
  repeated_.is(frame_);
  frame_.T_previous_left->translation().z() = 1e-12;
  EXPECT_FALSE(repeated_.is(frame_));
  frame_.T_previous_left->linear() = so3_exp({0, 0.01, 0});
  EXPECT_TRUE(repeated_.is(frame_));
}

TEST_F(RepeatedPairTest, WithoutAPlanNobodyKnows) {
  repeated_.is(frame_);
  frame_.T_previous_left.reset();
  EXPECT_FALSE(repeated_.is(frame_));
}

}  // namespace
}  // namespace groundloop::slam
