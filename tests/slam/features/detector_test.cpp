#include "slam/features/detector.h"

#include <gmock/gmock.h>

#include "slam/features/affine_klt.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

using testing::ElementsAreArray;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr int kPitch = 48, kColumns = 6, kRows = 5;
constexpr int kBorder = 8;

/// Dark squares of 24 px on light ground, 48 px apart, with edges as wide as a lens makes them. Their corners
/// are at 48 i + 11.5 and 48 i + 35.5 in both directions.
cv::Mat board() {
  const auto inside = [](double x) {
    const double from_middle = std::abs(std::fmod(x + 0.5, kPitch) - kPitch / 2);
    return 0.5 - 0.5 * std::tanh((from_middle - kPitch / 4) / 0.7);
  };
  return draw({kColumns * kPitch, kRows * kPitch}, {},
              [&](int u, int v) { return 190 - 130 * inside(u) * inside(v); });
}

cv::Mat textured() {
  const Texture texture(4, 8, 40);
  return draw({320, 240}, {}, [&](int u, int v) { return texture.at(u, v); });
}

double nearest(const std::vector<Eigen::Vector2f>& points, const Eigen::Vector2f& p) {
  double least = 1e9;
  for (const Eigen::Vector2f& q : points) least = std::min(least, static_cast<double>((p - q).norm()));
  return least;
}

TEST(Detector, FindsEveryCornerOfABoardAndNothingElse) {
  Detector detector({});
  const std::vector<Eigen::Vector2f> corners = detector.detect(board(), {}, 1000, kBorder);
  EXPECT_THAT(corners, SizeIs(4 * kColumns * kRows));
  // The response is strongest where the 5 x 5 window holds most of both edges: 1.5 px inside the corner, both
  // ways.
  for (int j = 0; j < 2 * kRows; ++j) {
    for (int i = 0; i < 2 * kColumns; ++i) {
      const Eigen::Vector2f exact(static_cast<float>(i * kPitch / 2) + 11.5F,
                                  static_cast<float>(j * kPitch / 2) + 11.5F);
      EXPECT_LT(nearest(corners, exact), 2.2) << exact.transpose();
    }
  }
}

TEST(Detector, KeepsItsDistanceFromItselfAndFromWhatIsThere) {
  for (const double distance : {5.0, 14.0, 31.5}) {
    DetectionOptions options;
    options.min_distance_px = distance;
    Detector detector(options);
    const std::vector<Eigen::Vector2f> occupied = {{100.3F, 80.6F}, {250, 200}, {160, 120}};
    const auto corners = detector.detect(textured(), occupied, 10000, kBorder);
    ASSERT_GT(corners.size(), 20u);
    for (size_t i = 0; i < corners.size(); ++i) {
      EXPECT_GE(nearest(occupied, corners[i]), distance);
      for (size_t j = 0; j < i; ++j) EXPECT_GE((corners[i] - corners[j]).norm(), distance);
    }
  }
}

TEST(Detector, AnOccupiedCornerIsLeftOut) {
  Detector detector({});
  const Eigen::Vector2f taken(83.5F, 59.5F);
  const auto corners = detector.detect(board(), {taken}, 1000, kBorder);
  EXPECT_THAT(corners, SizeIs(4 * kColumns * kRows - 1));
  EXPECT_GT(nearest(corners, taken), 14);
}

TEST(Detector, KeepsOffTheBorder) {
  for (const int border : {3, 18, 50}) {
    Detector detector({});
    const auto corners = detector.detect(textured(), {}, 10000, border);
    ASSERT_FALSE(corners.empty());
    for (const Eigen::Vector2f& p : corners) {
      EXPECT_GE(p.x(), border);
      EXPECT_GE(p.y(), border);
      EXPECT_LT(p.x(), 320 - border);
      EXPECT_LT(p.y(), 240 - border);
    }
  }
}

TEST(Detector, GivesTheStrongestOfWhatWasWanted) {
  Detector detector({});
  const std::vector<Eigen::Vector2f> all = detector.detect(textured(), {}, 10000, kBorder);
  ASSERT_GT(all.size(), 50u);
  const std::vector<Eigen::Vector2f> some = detector.detect(textured(), {}, 40, kBorder);
  EXPECT_THAT(some, ElementsAreArray(all.begin(), all.begin() + 40));
  EXPECT_THAT(detector.detect(textured(), {}, 0, kBorder), IsEmpty());
  EXPECT_THAT(detector.detect(textured(), {}, -5, kBorder), IsEmpty());
}

TEST(Detector, TwoDetectorsGiveTheSameOrder) {
  Detector a({}), b({});
  b.detect(board(), {}, 10, kBorder);  // what was seen before leaves no trace
  const std::vector<Eigen::Vector2f> first = a.detect(textured(), {}, 500, kBorder);
  EXPECT_THAT(b.detect(textured(), {}, 500, kBorder), ElementsAreArray(first));
}

TEST(Detector, FindsNothingOnAFlatWall) {
  Detector detector({});
  EXPECT_THAT(detector.detect(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), {}, 1000, kBorder), IsEmpty());
  const cv::Mat quiet = draw({320, 240}, {1, 0, 0.5, 3}, [](int, int) { return 128; });
  EXPECT_THAT(detector.detect(quiet, {}, 1000, kBorder), IsEmpty());
}

TEST(Detector, WhatTheNoiseOfASensorOffersIsNoFirstView) {
  // The read noise of a head on a flat wall may pass for corners; none of them can be held.
  const cv::Mat noisy = draw({320, 240}, {1, 0, 1.5, 3}, [](int, int) { return 128; });
  ImagePyramid pyramid;
  pyramid.build(noisy, 4);
  Detector detector({});
  PatchTemplate patch;
  for (const Eigen::Vector2f& p : detector.detect(noisy, {}, 1000, 18))
    EXPECT_FALSE(patch.take(pyramid, p, 4));
}

TEST(Detector, AStraightEdgeIsNoCorner) {
  Detector detector({});
  for (const double angle : {0.0, 0.5, 1.2}) {
    const double c = std::cos(angle), s = std::sin(angle);
    cv::Mat image = draw({320, 240}, {}, [&](int u, int v) {
      return 120 + 80 * std::tanh((c * (u - 160.0) + s * (v - 120.0)) / 1.5);
    });
    // one true corner, which says what is strong
    image(cv::Rect(30, 30, 30, 30)).setTo(128);
    const auto corners = detector.detect(image, {}, 1000, kBorder);
    EXPECT_THAT(corners, Not(IsEmpty()));
    for (const Eigen::Vector2f& p : corners) EXPECT_LT((p - Eigen::Vector2f(45, 45)).norm(), 30) << angle;
  }
}

TEST(Detector, AnImageWithoutInsideHasNoCorners) {
  Detector detector({});
  EXPECT_THAT(detector.detect(board()(cv::Rect(0, 0, 18, 18)), {}, 10, kBorder), IsEmpty());
}

}  // namespace
}  // namespace groundloop::slam
