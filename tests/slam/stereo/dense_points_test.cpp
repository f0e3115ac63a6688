#include "slam/stereo/dense_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "slam/stereo/on_time_view.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/stereo/late_pair.h"

namespace groundloop::slam {
namespace {

const cv::Size kSize(480, 240);

/// Grey level of a texture, a function of its place alone.
double waves(double x, double y) {
  static const Texture texture(7, 9, 60);
  return texture.at(x, y);
}

Light noisy(double noise_grey, uint64_t seed, double offset_grey = 0) {
  return {.bias_grey = offset_grey, .noise_grey = noise_grey, .seed = seed};
}

struct Pair {
  cv::Mat left, right;
};

/// A plane of disparity d + a u + b v, noise of standard deviation `noise` in both images.
struct Plane {
  double d, a, b;
  double at(double u, double v) const { return d + a * u + b * v; }
};
Pair pair_of(const Plane& plane, double noise, double offset = 0) {
  Pair pair;
  pair.left = draw(kSize, noisy(noise, 1), [](int u, int v) { return waves(u, v); });
  pair.right = draw(kSize, noisy(noise, 2, offset),
                    [&](int x, int v) { return waves((x + plane.d + plane.b * v) / (1 - plane.a), v); });
  return pair;
}

std::vector<DensePoint> measure(const Pair& pair, const DenseMapOptions& options = {}) {
  DenseDisparity rough({});
  rough.compute(pair.left, pair.right);
  DensePoints points(centred_rig(kSize.width, kSize.height, 400, 0.1), options);
  return points.measure(pair.left, pair.right, rough.half_resolution());
}

struct Errors {
  double mean = 0, rms = 0, normalised = 0;
};
Errors errors_of(const std::vector<DensePoint>& points, const Plane& plane) {
  Errors errors;
  for (const DensePoint& p : points) {
    const double e = p.uvu_px.x() - p.uvu_px.z() - plane.at(p.uvu_px.x(), p.uvu_px.y());
    errors.mean += e, errors.rms += e * e, errors.normalised += e * e / (p.sigma_px * p.sigma_px);
  }
  const auto n = static_cast<double>(points.size());
  return {errors.mean / n, std::sqrt(errors.rms / n), std::sqrt(errors.normalised / n)};
}

TEST(DensePoints, MeasureLevelAndSlantedPlanesToAFractionOfAPixel) {
  for (const Plane plane :
       {Plane{20.3, 0, 0}, Plane{31.7, 0.02, 0}, Plane{12, 0, 0.1}, Plane{40, -0.04, 0.06}}) {
    const auto points = measure(pair_of(plane, 0));
    ASSERT_GT(points.size(), 800U) << plane.a << ", " << plane.b;
    const Errors errors = errors_of(points, plane);
    EXPECT_NEAR(errors.mean, 0, 0.02) << plane.a << ", " << plane.b;
    EXPECT_LT(errors.rms, 0.06) << plane.a << ", " << plane.b;
  }
}

TEST(DensePoints, AreNotDrawnToWholeOrHalfPixels) {
  for (int i = 0; i <= 10; ++i) {
    const Plane plane{20 + 0.1 * i, 0, 0};
    EXPECT_NEAR(errors_of(measure(pair_of(plane, 2)), plane).mean, 0, 0.02) << plane.d;
  }
}

TEST(DensePoints, DoNotOverstateWhatTheyKnow) {
  DenseMapOptions options;
  options.max_sigma_px = 1;
  for (const double noise : {0.0, 2.0, 6.0}) {
    const Plane plane{25.4, 0.01, 0.02};
    const Errors errors = errors_of(measure(pair_of(plane, noise), options), plane);
    EXPECT_LT(errors.normalised, 1.2) << noise;
  }
}

TEST(DensePoints, TheImagesNeedNotBeEquallyBright) {
  const Plane plane{25.4, 0.01, 0};
  const Errors errors = errors_of(measure(pair_of(plane, 1, 9)), plane);
  EXPECT_LT(errors.rms, 0.08);
}

TEST(DensePoints, ANearThingDoesNotThickenBeforeAPlainWall) {
  // A textured board over the columns [200, 280) before a wall of one grey: all that windows beside the board
  // see of it is the board's edge, and that is where their points belong.
  constexpr int kFirst = 200, kEnd = 280, kNear_px = 40;
  const auto on_board = [](int u) { return u >= kFirst && u < kEnd; };
  Pair pair;
  pair.left = draw(kSize, noisy(1.5, 1), [&](int u, int v) { return on_board(u) ? waves(u, v) : 200.0; });
  pair.right = draw(kSize, noisy(1.5, 2),
                    [&](int u, int v) { return on_board(u + kNear_px) ? waves(u + kNear_px, v) : 200.0; });
  const auto points = measure(pair);
  ASSERT_GT(points.size(), 200U);
  for (const DensePoint& p : points) {
    EXPECT_NEAR(p.uvu_px.x() - p.uvu_px.z(), kNear_px, 0.5);
    EXPECT_GT(p.uvu_px.x(), kFirst - 3);
    EXPECT_LT(p.uvu_px.x(), kEnd + 2);
  }
}

TEST(DensePoints, NoTextureNoPoint) {
  Pair pair;
  pair.left = draw(kSize, noisy(2, 1), [](int, int) { return 120.0; });
  pair.right = draw(kSize, noisy(2, 2), [](int, int) { return 120.0; });
  EXPECT_LT(measure(pair).size(), 5U);
  // Level stripes are texture, but none that fixes a disparity.
  pair.left = draw(kSize, noisy(2, 1), [](int, int v) { return waves(0, v); });
  pair.right = draw(kSize, noisy(2, 2), [](int, int v) { return waves(0, v); });
  EXPECT_LT(measure(pair).size(), 5U);
}

TEST(DensePoints, WindowsThatDisagreeAreLeftOut) {
  // A quarter of the right image shows something else at the same coarse place.
  Pair pair = pair_of({20, 0, 0}, 1);
  const size_t all = measure(pair).size();
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      pair.right.at<uint8_t>(v, u) =
          cv::saturate_cast<uint8_t>(pair.right.at<uint8_t>(v, u) + 25 * gaussian(3, u, v));
    }
  }
  const auto points = measure(pair);
  EXPECT_GT(points.size(), 0.6 * static_cast<double>(all));
  for (const DensePoint& p : points) EXPECT_GT(p.uvu_px.y(), 55);
}

TEST(DensePoints, StepSaysHowMany) {
  const Pair pair = pair_of({20, 0, 0}, 1);
  DenseMapOptions options;
  options.step_px = 0;
  EXPECT_TRUE(measure(pair, options).empty());
  options.step_px = 8;
  const size_t eight = measure(pair, options).size();
  options.step_px = 4;
  const auto four = static_cast<double>(measure(pair, options).size());
  EXPECT_NEAR(four / static_cast<double>(eight), 4, 0.4);
}

TEST(DensePoints, OfALateRightImageAreThoseOfAPairTakenTogether) {
  const auto errors_of_pair = [](const LatePair& pair, const RightLag& told, size_t& count) {
    DenseDisparity rough({});
    const OnTimeView view(pair.rig, told, 1.5);
    rough.compute(pair.left, pair.right, told.none() ? nullptr : &view);
    DensePoints points(pair.rig, {});
    const auto& measured = points.measure(pair.left, pair.right, rough.half_resolution(), told);
    count = measured.size();
    std::vector<double> off_px;
    for (const DensePoint& p : measured)
      off_px.push_back(std::abs(p.uvu_px.x() - p.uvu_px.z() - pair.disparity_px(p.uvu_px.x(), p.uvu_px.y())));
    std::sort(off_px.begin(), off_px.end());
    return Errors{off_px[count / 2], off_px[count * 9 / 10], 0};
  };
  size_t in_time = 0, told = 0, untold = 0;
  const Errors best = errors_of_pair(LatePair(0), {}, in_time);
  for (const double late_s : {0.05, -0.03}) {
    const LatePair pair(late_s);
    const Errors errors = errors_of_pair(pair, pair.lag, told);
    EXPECT_LT(errors.mean, best.mean + 0.02) << late_s;
    EXPECT_LT(errors.rms, best.rms + 0.05) << late_s;
    EXPECT_GT(told, 0.9 * static_cast<double>(in_time)) << late_s;
    EXPECT_GT(errors_of_pair(pair, {}, untold).mean, 4) << late_s;
  }
}

}  // namespace
}  // namespace groundloop::slam
