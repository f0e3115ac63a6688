#include "slam/stereo/row_alignment.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

/// Row differences of a hundred matches, spread evenly over `spread_px` about the middle.
std::vector<float> about(double middle_px, double spread_px = 0.4, int matches = 100) {
  std::vector<float> px;
  for (int i = 0; i < matches; ++i) {
    px.push_back(static_cast<float>(middle_px + spread_px * ((i + 0.5) / matches - 0.5)));
  }
  return px;
}

class RowAlignmentTest : public testing::Test {
 protected:
  std::optional<double> observe(std::vector<float> differences_px) { return rows_.observe(differences_px); }

  RowAlignment rows_{StereoOptions{}};  // gate 0.8 px, slip up to 5 px
};

TEST_F(RowAlignmentTest, ImagesPassThroughUntouchedWhileRowsAreRight) {
  const cv::Mat right(24, 32, CV_8UC1, cv::Scalar(7));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(observe(about(0.3)));
  EXPECT_EQ(rows_.offset_px(), 0);
  EXPECT_EQ(rows_.aligned(right).data, right.data);
}

TEST_F(RowAlignmentTest, ThreePairsThatAreOffAlikeAreASlip) {
  EXPECT_NEAR(*observe(about(1.2)), 1.2, 0.01);
  EXPECT_NEAR(*observe(about(1.3)), 1.3, 0.01);
  EXPECT_EQ(rows_.offset_px(), 0);
  EXPECT_NEAR(*observe(about(1.4)), 1.4, 0.01);
  EXPECT_NEAR(rows_.offset_px(), 1.3, 0.01);
  // the next slip is told on top of it: back where it was
  for (int i = 0; i < 3; ++i) observe(about(-1.3));
  EXPECT_NEAR(rows_.offset_px(), 0, 0.01);
}

TEST_F(RowAlignmentTest, APairInBetweenBeginsItAnew) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(observe(about(1.2)));
    EXPECT_TRUE(observe(about(1.2)));
    EXPECT_FALSE(observe(about(0)));
  }
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(observe(about(i % 2 == 0 ? 1.2 : 2.8)));
  EXPECT_EQ(rows_.offset_px(), 0);
}

TEST_F(RowAlignmentTest, FewMatchesAndMatchesAtOddsTellNothing) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(observe({}));
    EXPECT_FALSE(observe(about(1.2, 0.4, 20)));
    EXPECT_FALSE(observe(about(3, 8)));
  }
  EXPECT_EQ(rows_.offset_px(), 0);
}

TEST_F(RowAlignmentTest, AFewWrongMatchesDoNotMoveIt) {
  std::vector<float> differences_px = about(1.2);
  for (int i = 0; i < 20; ++i) differences_px.push_back(-4);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(observe(differences_px));
  EXPECT_NEAR(rows_.offset_px(), 1.2, 0.06);
}

TEST_F(RowAlignmentTest, TooLargeASlipIsToldAndLeft) {
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(*observe(about(5.4)), 5.4, 0.01);
  EXPECT_EQ(rows_.offset_px(), 0);
  rows_ = RowAlignment({.max_row_offset_px = 0});
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(observe(about(1.2)));
  EXPECT_EQ(rows_.offset_px(), 0);
}

TEST_F(RowAlignmentTest, MovesTheRowsBack) {
  constexpr double kSlip_px = 1.4;
  const Texture texture(5, 9, 60);
  const cv::Size size(120, 90);
  const cv::Mat there = draw(size, {}, [&](int u, int v) { return texture.at(u, v); });
  const cv::Mat slipped = draw(size, {}, [&](int u, int v) { return texture.at(u, v - kSlip_px); });
  for (int i = 0; i < 3; ++i) observe(about(kSlip_px));
  const cv::Mat back = rows_.aligned(slipped);
  const cv::Rect inside(0, 3, size.width, size.height - 6);
  EXPECT_LE(cv::norm(back(inside), there(inside), cv::NORM_INF), 3);
  EXPECT_EQ(rows_.aligned(slipped).data, back.data) << "one buffer for all pairs";
}

}  // namespace
}  // namespace groundloop::slam
