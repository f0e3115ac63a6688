#include "slam/stereo/matcher.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "slam/stereo/on_time_view.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/stereo/late_pair.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

const cv::Size kSize(320, 240);

StereoRig rig_of_size() { return centred_rig(kSize.width, kSize.height, 300, 0.1); }

/// A wall that the right image has `disparity_px` to the left and `rows_px` lower.
struct Wall {
  Wall(double disparity_px, double rows_px) {
    const Texture texture(5, 9, 60);
    left = draw(kSize, {}, [&](int u, int v) { return texture.at(u, v); });
    right = draw(kSize, {}, [&](int u, int v) { return texture.at(u + disparity_px, v - rows_px); });
    left_pyramid.build(left, 4);
    right_pyramid.build(right, 4);
  }
  cv::Mat left, right;
  ImagePyramid left_pyramid, right_pyramid;
};

/// Matches features all over the wall; every plausible match must be right.
struct Matches {
  int asked = 0, found = 0;
};
Matches match_all(const Wall& wall, const StereoOptions& options, const DenseDisparity& dense,
                  const Eigen::Vector2d& exact_offset) {
  const StereoMatcher matcher(rig_of_size(), options, {});
  Matches matches;
  PatchTemplate patch;
  for (int v = 40; v < 200; v += 23) {
    for (int u = 100; u < 290; u += 23) {
      const Eigen::Vector2f at(static_cast<float>(u), static_cast<float>(v));
      if (!patch.take(wall.left_pyramid, at, 4)) continue;
      ++matches.asked;
      AffineState left;
      left.uv_px = at;
      const auto right = matcher.match(patch, left, dense, wall.right_pyramid);
      if (!right || !matcher.plausible(at, right->uv_px)) continue;
      ++matches.found;
      EXPECT_LT((right->uv_px.cast<double>() - at.cast<double>() - exact_offset).norm(), 0.06);
    }
  }
  EXPECT_GT(matches.asked, 40);
  return matches;
}

DenseDisparity dense_of(const Wall& wall) {
  DenseDisparity dense({});
  dense.compute(wall.left, wall.right);
  return dense;
}

TEST(StereoMatcher, FindsAKnownShift) {
  for (const double disparity_px : {3.3, 17.6, 41.25}) {
    const Wall wall(disparity_px, 0);
    const Matches m = match_all(wall, {}, dense_of(wall), {-disparity_px, 0});
    EXPECT_GT(m.found, 0.95 * m.asked) << disparity_px;
  }
}

TEST(StereoMatcher, RowsMustAgreeWithinTheGate) {
  const Wall within(20, 0.7), beyond(20, 1.4);
  const Matches near = match_all(within, {}, dense_of(within), {-20, 0.7});
  EXPECT_GT(near.found, 0.9 * near.asked);
  EXPECT_EQ(match_all(beyond, {}, dense_of(beyond), {-20, 1.4}).found, 0);
  StereoOptions wide;
  wide.epipolar_gate_px = 2;
  const Matches all = match_all(beyond, wide, dense_of(beyond), {-20, 1.4});
  EXPECT_GT(all.found, 0.8 * all.asked);
}

TEST(StereoMatcher, TheDistanceThatCarriesNoDepthIsRefused) {
  const Wall wall(3, 0);
  StereoOptions options;
  options.min_disparity_px = 3.5;
  EXPECT_EQ(match_all(wall, options, dense_of(wall), {-3, 0}).found, 0);
  options.min_disparity_px = 2.5;
  EXPECT_GT(match_all(wall, options, dense_of(wall), {-3, 0}).found, 30);
}

TEST(StereoMatcher, WhatIsFarFromTheDenseMapIsAnotherSurface) {
  const Wall seen(22.5, 0);
  const DenseDisparity other = dense_of(Wall(20, 0));
  StereoOptions strict;
  strict.max_prediction_error_px = 1;
  EXPECT_EQ(match_all(seen, strict, other, {-22.5, 0}).found, 0);
  EXPECT_GT(match_all(seen, {}, other, {-22.5, 0}).found, 30);
}

TEST(StereoMatcher, InALateImageItIsFoundWhereThatShowsIt) {
  const LatePair pair;
  const OnTimeView view(pair.rig, pair.lag, 1.5);
  DenseDisparity dense({});
  dense.compute(pair.left, pair.right, &view);
  ImagePyramid left_pyramid, right_pyramid;
  left_pyramid.build(pair.left, 4);
  right_pyramid.build(pair.right, 4);
  const StereoMatcher matcher(pair.rig, {.max_prediction_error_px = 1}, {});
  PatchTemplate patch;
  int asked = 0, found = 0;
  for (int v = 40; v < 280; v += 23) {
    for (int u = 100; u < 440; u += 23) {
      const Eigen::Vector2f at(static_cast<float>(u), static_cast<float>(v));
      if (!patch.take(left_pyramid, at, 4)) continue;
      ++asked;
      AffineState left;
      left.uv_px = at;
      const auto right = matcher.match(patch, left, dense, right_pyramid, pair.lag);
      if (!right) continue;
      ++found;
      const auto p_left = pair.rig.triangulate(Eigen::Vector3d(u, v, u - pair.disparity_px(u, v)));
      const Eigen::Vector3d late = pair.rig.project(pair.lag.T_late_left() * *p_left);
      EXPECT_LT((right->uv_px.cast<double>() - Eigen::Vector2d(late.z(), late.y())).norm(), 0.4)
          << at.transpose();
    }
  }
  EXPECT_GT(found, 0.9 * asked);
}

TEST(StereoMatcher, NothingDenseNothingMatched) {
  const Wall wall(20, 0);
  const DenseDisparity nothing({});
  EXPECT_EQ(match_all(wall, {}, nothing, {-20, 0}).found, 0);
}

TEST(StereoMatcher, PlausibleCountsFromInfinity) {
  StereoRig rig = rig_of_size();
  rig.cx_right_px = rig.cx_px - 10;  // points at infinity have a disparity of 10
  const StereoMatcher matcher(rig, {}, {});
  EXPECT_TRUE(matcher.plausible({100, 50}, {85, 50.7F}));
  EXPECT_FALSE(matcher.plausible({100, 50}, {85, 51.1F}));
  EXPECT_FALSE(matcher.plausible({100, 50}, {85, 48.9F}));
  EXPECT_TRUE(matcher.plausible({100, 50}, {88.9F, 50}));
  EXPECT_FALSE(matcher.plausible({100, 50}, {89.1F, 50}));
  EXPECT_FALSE(matcher.plausible({100, 50}, {110, 50}));
  EXPECT_FALSE(matcher.plausible({std::nanf(""), 50}, {85, 50}));
}

TEST(OptimalMeasurement, IsTheOptimalTriangulationOfARectifiedPair) {
  // OpenCV solves Hartley and Sturm's problem for any geometry; x_right^T F x_left = y_left - y_right.
  const cv::Matx33d F(0, 0, 0, 0, 0, -1, 0, 1, 0);
  std::vector<cv::Point2d> left, right, best_left, best_right;
  for (uint64_t i = 0; i < 200; ++i) {
    // Steps of 1 / 1024 px are exact in float.
    const auto coordinate = [i](uint64_t stream, uint32_t range_px) {
      return random_index(random_bits(3, stream, i), range_px * 1024) / 1024.0;
    };
    const double u = coordinate(1, 640), v = coordinate(2, 480);
    left.emplace_back(u, v);
    right.emplace_back(u - coordinate(3, 100), v + coordinate(4, 4) - 2);
  }
  cv::correctMatches(F, left, right, best_left, best_right);
  for (size_t i = 0; i < left.size(); ++i) {
    const Eigen::Vector3d uvu = optimal_measurement(Eigen::Vector2d(left[i].x, left[i].y).cast<float>(),
                                                    Eigen::Vector2d(right[i].x, right[i].y).cast<float>());
    EXPECT_NEAR(uvu.x(), best_left[i].x, 1e-9);
    EXPECT_NEAR(uvu.y(), best_left[i].y, 1e-9);
    EXPECT_NEAR(uvu.y(), best_right[i].y, 1e-9);
    EXPECT_NEAR(uvu.z(), best_right[i].x, 1e-9);
  }
}

/// Covariance of (u_left, v, u_right) when the positions in both images have this covariance and are
/// correlated like this: by the linear map from (u_left, v_left, u_right, v_right).
Eigen::Matrix3d through_the_mean_of_the_rows(const Eigen::Matrix2d& C, double correlation) {
  Eigen::Matrix4d both;
  both << C, correlation * C, correlation * C, C;
  Eigen::Matrix<double, 3, 4> mean;
  mean << 1, 0, 0, 0, 0, 0.5, 0, 0.5, 0, 0, 1, 0;
  return mean * both * mean.transpose();
}

TEST(MatchCofactor, IsThatOfTwoPositionsOfTheSamePrecision) {
  const Eigen::Matrix3d best = match_cofactor(Eigen::Matrix2f::Zero(), Eigen::Matrix2f::Zero());
  const double correlation = best(0, 2) / best(0, 0);
  EXPECT_GT(correlation, 0);
  EXPECT_LT(correlation, 1);
  EXPECT_LT(
      (best - through_the_mean_of_the_rows(best(0, 0) * Eigen::Matrix2d::Identity(), correlation)).norm(),
      1e-12);

  Eigen::Matrix2f left, right;
  left << 0.02F, 0.004F, 0.004F, 0.003F;
  right << 0.01F, -0.002F, -0.002F, 0.005F;
  const Eigen::Matrix3d added = match_cofactor(left, right) - best;
  const Eigen::Matrix2d mean = 0.5 * (left + right).cast<double>();
  const double scale = added(0, 0) / mean(0, 0);
  EXPECT_LT((added - scale * through_the_mean_of_the_rows(mean, correlation)).norm(), 1e-5 * added.norm());
}

TEST(MatchCofactor, AMatchOfTheTypicalPrecisionCountsAsStated) {
  const Eigen::Matrix2f typical = 0.07F * 0.07F * Eigen::Matrix2f::Identity();
  const Eigen::Matrix3d cofactor = match_cofactor(typical, typical);
  EXPECT_NEAR(cofactor(0, 0), 1, 0.2);
  EXPECT_NEAR(cofactor(2, 2), 1, 0.2);
  EXPECT_GT(cofactor(1, 1), 0.5) << "the rows of both images err partly alike";
}

}  // namespace
}  // namespace groundloop::slam
