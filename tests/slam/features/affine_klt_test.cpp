#include "slam/features/affine_klt.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

const cv::Size kSize(240, 200);
const Eigen::Vector2d kMiddle(119.5, 99.5);

Eigen::Matrix2d rotation(double deg) {
  const double a = deg * std::numbers::pi / 180;
  return (Eigen::Matrix2d() << std::cos(a), -std::sin(a), std::sin(a), std::cos(a)).finished();
}

ImagePyramid pyramid_of(const cv::Mat& image, int levels = 4) {
  ImagePyramid pyramid;
  pyramid.build(image, levels);
  return pyramid;
}

/// A first picture and one of the same texture after x -> A (x - middle) + middle + shift.
struct Pair {
  Pair(uint64_t seed, const Eigen::Matrix2d& warp, const Eigen::Vector2d& moved, const Light& light = {},
       const Light& first_light = {}, double shortest_px = 9, double longest_px = 50)
      : A(warp), shift(moved) {
    const Texture texture(seed, shortest_px, longest_px);
    first = pyramid_of(draw(kSize, first_light, [&](int u, int v) { return texture.at(u, v); }));
    const Eigen::Matrix2d back = A.inverse();
    second = pyramid_of(draw(kSize, light, [&](int u, int v) {
      const Eigen::Vector2d x = back * (Eigen::Vector2d(u, v) - kMiddle - shift) + kMiddle;
      return texture.at(x.x(), x.y());
    }));
  }
  Eigen::Vector2d answer(const Eigen::Vector2d& x) const { return A * (x - kMiddle) + kMiddle + shift; }

  Eigen::Matrix2d A;
  Eigen::Vector2d shift;
  ImagePyramid first, second;
};

/// Distances to the right answer [px] of features all over the image, in order; tracked ones only.
struct Errors {
  std::vector<double> position_px;
  std::vector<double> shape;  ///< largest entry of A - exact A
  int features = 0;

  double worst() const { return position_px.empty() ? 1e9 : position_px.back(); }
  double median() const { return position_px.empty() ? 1e9 : position_px[position_px.size() / 2]; }
};

/// @param start_offset  wrong start, added to the position before the motion
Errors track(const Pair& pair, const Eigen::Vector2d& start_offset, int start_level = 3,
             const Eigen::Matrix2d& start_shape = Eigen::Matrix2d::Identity()) {
  Errors errors;
  PatchTemplate patch;
  for (double y = 50.3; y < 150; y += 19.7) {
    for (double x = 55.6; x < 185; x += 21.3) {
      const Eigen::Vector2d at(x, y);
      if (!patch.take(pair.first, at.cast<float>(), 4)) continue;
      ++errors.features;
      AffineState state;
      state.uv_px = (at + start_offset).cast<float>();
      state.A = start_shape.cast<float>();
      if (track_affine(patch, pair.second, KltOptions{}, start_level, state) != KltStatus::kTracked) continue;
      errors.position_px.push_back((state.uv_px.cast<double>() - pair.answer(at)).norm());
      errors.shape.push_back((state.A.cast<double>() - pair.A).cwiseAbs().maxCoeff());
    }
  }
  std::sort(errors.position_px.begin(), errors.position_px.end());
  std::sort(errors.shape.begin(), errors.shape.end());
  return errors;
}

const Eigen::Matrix2d kIdentity = Eigen::Matrix2d::Identity();

TEST(TrackAffine, WithoutMotionFindsItselfAtOnce) {
  const Pair pair(1, kIdentity, {0, 0});
  const Errors errors = track(pair, {0, 0}, 0);
  ASSERT_GE(errors.features, 30);
  EXPECT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features));
  EXPECT_LT(errors.worst(), 1e-3);
}

TEST(TrackAffine, RecoversASubPixelTranslation) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0.25, 0.6), Eigen::Vector2d(-0.5, 0.5), Eigen::Vector2d(1.37, -0.81)}) {
    const Pair pair(2, kIdentity, shift);
    const Errors errors = track(pair, {0, 0}, 1);
    EXPECT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features));
    EXPECT_LT(errors.worst(), 0.05) << shift.transpose();
  }
}

TEST(TrackAffine, ConvergesFromThreePixelsAway) {
  const Pair pair(3, kIdentity, {0.3, -0.4});
  for (const Eigen::Vector2d& offset :
       {Eigen::Vector2d(3, 3), Eigen::Vector2d(-3, 3), Eigen::Vector2d(3, -3), Eigen::Vector2d(-3, -3)}) {
    const Errors errors = track(pair, offset);
    EXPECT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features)) << offset.transpose();
    EXPECT_LT(errors.worst(), 0.05) << offset.transpose();
  }
}

TEST(TrackAffine, ConvergesFromFarWithThePyramid) {
  const Pair pair(4, kIdentity, {7.3, -5.4});
  const Errors errors = track(pair, {0, 0}, 3);
  EXPECT_GE(errors.position_px.size(), errors.features * 9u / 10);
  EXPECT_LT(errors.median(), 0.05);
}

struct Warp {
  const char* name;
  Eigen::Matrix2d A;
};

class TrackAffineWarp : public testing::TestWithParam<Warp> {};

TEST_P(TrackAffineWarp, IsFoundFromAnUnwarpedStart) {
  const Pair pair(5, GetParam().A, {0.35, -0.2});
  // The motion of the window's middle is told, the shape is not. The accuracy is that of the method, iterated
  // to its end; the default stops when the position stands still, a little before the shape does.
  KltOptions patient;
  patient.max_iterations = 50;
  patient.converged_px = 2e-4;
  Errors errors;
  std::vector<double> hasty_px;
  PatchTemplate patch;
  for (double y = 55.3; y < 150; y += 18.7) {
    for (double x = 60.6; x < 180; x += 19.3) {
      const Eigen::Vector2d at(x, y);
      if (!patch.take(pair.first, at.cast<float>(), 4)) continue;
      ++errors.features;
      AffineState start;
      start.uv_px = (pair.answer(at) + Eigen::Vector2d(0.8, -0.7)).cast<float>();
      AffineState state = start;
      if (track_affine(patch, pair.second, patient, 1, state) != KltStatus::kTracked) continue;
      errors.position_px.push_back((state.uv_px.cast<double>() - pair.answer(at)).norm());
      errors.shape.push_back((state.A.cast<double>() - pair.A).cwiseAbs().maxCoeff());
      AffineState hasty = start;
      ASSERT_EQ(track_affine(patch, pair.second, KltOptions{}, 1, hasty), KltStatus::kTracked);
      hasty_px.push_back((hasty.uv_px.cast<double>() - pair.answer(at)).norm());
    }
  }
  std::sort(errors.position_px.begin(), errors.position_px.end());
  std::sort(errors.shape.begin(), errors.shape.end());
  std::sort(hasty_px.begin(), hasty_px.end());
  ASSERT_GE(errors.features, 30);
  ASSERT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features));
  EXPECT_LT(errors.worst(), 0.08);
  EXPECT_LT(hasty_px[hasty_px.size() / 2], 0.04);
  EXPECT_LT(hasty_px.back(), 0.2);
  EXPECT_LT(errors.shape[errors.shape.size() / 2], 0.02);
}

INSTANTIATE_TEST_SUITE_P(Warps, TrackAffineWarp,
                         testing::Values(Warp{"Scale", 1.15 * Eigen::Matrix2d::Identity()},
                                         Warp{"Shrink", kIdentity / 1.15}, Warp{"Rotation", rotation(5)},
                                         Warp{"Shear", (Eigen::Matrix2d() << 1, 0.15, 0, 1).finished()}),
                         [](const auto& tested) { return tested.param.name; });

TEST(TrackAffine, AKnownShapeIsTakenAsStart) {
  const Eigen::Matrix2d A = 1.6 * rotation(35);
  const Pair pair(6, A, {0, 0});
  const Eigen::Vector2d at(116.2, 101.4);
  PatchTemplate patch;
  ASSERT_TRUE(patch.take(pair.first, at.cast<float>(), 4));
  AffineState state;
  state.uv_px = pair.answer(at).cast<float>();
  state.A = A.cast<float>();
  ASSERT_EQ(track_affine(patch, pair.second, KltOptions{}, 0, state), KltStatus::kTracked);
  EXPECT_LT((state.uv_px.cast<double>() - pair.answer(at)).norm(), 0.1);
  EXPECT_GT(state.ncc, 0.98);
}

TEST(TrackAffine, AKnownPerspectiveIsTakenOff) {
  // As on a wall that is driven along: magnified by a fifth, and more so to the right.
  const Eigen::Vector2d at(119.5, 99.5), c(-2.5e-3, 1e-3);
  const double scale = 1.2;
  Eigen::Vector2d sum_without(0, 0), sum_with(0, 0);
  int features = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Texture texture(seed, 9, 50);
    const ImagePyramid first = pyramid_of(draw(kSize, {}, [&](int u, int v) { return texture.at(u, v); }));
    // y = s x / (1 + c x) is undone by x = y / (s - c y).
    const ImagePyramid second = pyramid_of(draw(kSize, {}, [&](int u, int v) {
      const Eigen::Vector2d y = Eigen::Vector2d(u, v) - at;
      const Eigen::Vector2d x = y / (scale - c.dot(y)) + at;
      return texture.at(x.x(), x.y());
    }));
    PatchTemplate patch;
    if (!patch.take(first, at.cast<float>(), 4)) continue;
    patch.learn_pull();
    AffineState without;
    without.uv_px = at.cast<float>();
    AffineState with = without;
    with.c_per_px = c.cast<float>();
    if (track_affine(patch, second, KltOptions{}, 1, without) != KltStatus::kTracked) continue;
    if (track_affine(patch, second, KltOptions{}, 1, with) != KltStatus::kTracked) continue;
    sum_without += without.uv_px.cast<double>() - at;
    sum_with += with.uv_px.cast<double>() - at;
    ++features;
  }
  ASSERT_GT(features, 30);
  // Of a window of evenly spread texture: A x (c x) has a mean of 18.7 px^2 A c.
  EXPECT_GT(sum_without.norm() / features, 0.03);
  EXPECT_LT(sum_with.norm() / features, 0.01);
}

TEST(TrackAffine, GainAndBiasDoNotMatter) {
  // Gain 1.08 and bias 6 between two pictures that are clipped nowhere.
  const Light before{0.7, 30}, after{1.08 * 0.7, 1.08 * 30 + 6};
  const Pair pair(7, kIdentity, {0.4, 0.3}, after, before);
  const Errors errors = track(pair, {0, 0}, 1);
  EXPECT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features));
  EXPECT_LT(errors.worst(), 0.05);
}

TEST(TrackAffine, SensorNoiseCostsLittle) {
  const Pair pair(8, kIdentity, {0.4, 0.3}, {1, 0, 2.0, 11}, {1, 0, 2.0, 12});
  const Errors errors = track(pair, {0, 0}, 1);
  EXPECT_EQ(errors.position_px.size(), static_cast<size_t>(errors.features));
  EXPECT_LT(errors.median(), 0.1);
}

/// Errors of one feature found in many noisy pictures of the same scene. They are some three times what the
/// match says, in any direction and texture: interpolation smooths the noise that it is judged by.
TEST(TrackAffine, TheCovarianceHasTheShapeOfThatOfTheErrors) {
  constexpr int kPictures = 200;
  const cv::Size size(60, 60);
  const Eigen::Vector2d middle(29.5, 29.5), shift(0.3, -0.4);
  const Texture texture(5, 9, 50);
  KltOptions options;
  options.max_sigma_px = 10;
  for (const double width : {1.0, 5.0}) {  // stretched, the texture has little to tell of u
    const auto grey = [&](double u, double v) { return texture.at(u / width, v); };
    PatchTemplate patch;
    ASSERT_TRUE(patch.take(pyramid_of(draw(size, {}, grey), 2), middle.cast<float>(), 2));
    Eigen::Matrix2d said = Eigen::Matrix2d::Zero(), squares = said;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (uint64_t i = 0; i < kPictures; ++i) {
      const Light light{.noise_grey = 6, .seed = 900 + i};
      const cv::Mat noisy =
          draw(size, light, [&](int u, int v) { return grey(u - shift.x(), v - shift.y()); });
      AffineState state;
      state.uv_px = middle.cast<float>();
      ASSERT_EQ(track_affine(patch, pyramid_of(noisy, 2), options, 1, state), KltStatus::kTracked);
      const Eigen::Vector2d e = state.uv_px.cast<double>() - middle - shift;
      said += state.covariance_px2.cast<double>() / kPictures;
      squares += e * e.transpose() / kPictures;
      mean += e / kPictures;
    }
    const Eigen::Matrix2d errors = squares - mean * mean.transpose();
    for (int axis = 0; axis < 2; ++axis) {
      printf("width %.0f, axis %d: %.4f px, said %.4f\n", width, axis, std::sqrt(errors(axis, axis)),
             std::sqrt(said(axis, axis)));
      EXPECT_NEAR(std::sqrt(errors(axis, axis) / said(axis, axis)), 2.8, 0.7) << "axis " << axis;
    }
    EXPECT_EQ(said(0, 0) > 4 * said(1, 1), width > 1);
  }
}

/// A patch from the middle of a good picture.
class TrackAffineFails : public testing::Test {
 protected:
  TrackAffineFails() { EXPECT_TRUE(patch_.take(pair_.first, Eigen::Vector2f(100, 100), 4)); }
  KltStatus track(const ImagePyramid& pyramid, const Eigen::Vector2f& start,
                  const Eigen::Matrix2f& A = Eigen::Matrix2f::Identity()) {
    AffineState state;
    state.uv_px = start;
    state.A = A;
    return track_affine(patch_, pyramid, KltOptions{}, 1, state);
  }
  const Pair pair_{9, kIdentity, {0, 0}, {}, {}, 5, 15};  // rich: a smooth window looks like many others
  PatchTemplate patch_;
};

TEST_F(TrackAffineFails, OutsideWhenTheWindowLeavesTheImage) {
  for (const Eigen::Vector2f& at :
       {Eigen::Vector2f(5, 100), Eigen::Vector2f(235, 100), Eigen::Vector2f(100, 5),
        Eigen::Vector2f(100, 195), Eigen::Vector2f(-1e6F, 100), Eigen::Vector2f(1e9F, 100),
        Eigen::Vector2f(std::nanf(""), 100)}) {
    EXPECT_EQ(track(pair_.second, at), KltStatus::kOutside) << at.transpose();
  }
}

TEST_F(TrackAffineFails, PoorMatchInAFlatImage) {
  EXPECT_EQ(track(pyramid_of(cv::Mat(kSize, CV_8UC1, cv::Scalar(90))), {100, 100}), KltStatus::kPoorMatch);
}

TEST_F(TrackAffineFails, NeverTrackedInOtherContent) {
  int poor = 0, tracked = 0;
  for (uint64_t seed = 100; seed < 130; ++seed) {
    const Pair other(seed, kIdentity, {0, 0}, {}, {}, 5, 15);
    const KltStatus status = track(other.second, {100, 100});
    poor += status == KltStatus::kPoorMatch;
    tracked += status == KltStatus::kTracked;
  }
  EXPECT_EQ(tracked, 0);
  EXPECT_GE(poor, 10);  // the others ran away: outside, or out of shape
}

TEST_F(TrackAffineFails, DegenerateWhenTheShapeGrowsTooLarge) {
  // A picture of the same thing, seven times as large, and a start that knows: beyond the limit of 2.
  const Pair large(9, 2.6 * kIdentity, {0, 0}, {}, {}, 5, 15);
  AffineState state;
  state.uv_px = large.answer({100, 100}).cast<float>();
  state.A = 2.6F * Eigen::Matrix2f::Identity();
  EXPECT_EQ(track_affine(patch_, large.second, KltOptions{}, 0, state), KltStatus::kDegenerate);
}

TEST_F(TrackAffineFails, DegenerateWithoutAFirstView) {
  AffineState state;
  state.uv_px = {100, 100};
  EXPECT_EQ(track_affine(PatchTemplate{}, pair_.second, KltOptions{}, 1, state), KltStatus::kDegenerate);
}

TEST(PatchTemplate, RefusesWhatCannotBeHeld) {
  PatchTemplate patch;
  const ImagePyramid flat = pyramid_of(cv::Mat(kSize, CV_8UC1, cv::Scalar(90)));
  EXPECT_FALSE(patch.take(flat, {100, 100}, 4));
  EXPECT_EQ(patch.levels, 0);

  // An edge holds a window in one direction only: the aperture problem.
  for (const double angle : {0.0, 45.0, 90.0}) {
    const Eigen::Vector2d across = rotation(angle).col(0);
    const ImagePyramid edge = pyramid_of(draw(kSize, {}, [&](int u, int v) {
      const double distance = across.dot(Eigen::Vector2d(u - 100.0, v - 100.0));
      return 128 + 80 * std::tanh(distance / 1.5);
    }));
    EXPECT_FALSE(patch.take(edge, {100, 100}, 4)) << angle;
  }

  const ImagePyramid good = Pair(10, kIdentity, {0, 0}).first;
  EXPECT_TRUE(patch.take(good, {100, 100}, 4));
  for (const Eigen::Vector2f& at :
       {Eigen::Vector2f(4, 100), Eigen::Vector2f(236, 100), Eigen::Vector2f(100, 4),
        Eigen::Vector2f(100, 196), Eigen::Vector2f(-50, 100)}) {
    EXPECT_FALSE(patch.take(good, at, 4)) << at.transpose();
  }
}

TEST(PatchTemplate, UsesTheLevelsThatHoldTheWindow) {
  const ImagePyramid good = Pair(11, kIdentity, {0, 0}).first;
  PatchTemplate patch;
  ASSERT_TRUE(patch.take(good, {120, 100}, 4));
  EXPECT_EQ(patch.levels, 3);  // level 3 is 30 x 25 px: too small for a window and its surroundings
  ASSERT_TRUE(patch.take(good, {120, 100}, 2));
  EXPECT_EQ(patch.levels, 2);
  ASSERT_TRUE(patch.take(good, {22, 100}, 4));
  EXPECT_EQ(patch.levels, 2);
}

TEST(PatchTemplate, IsMeanFreeOfUnitNormWithEmptyPadding) {
  PatchTemplate patch;
  ASSERT_TRUE(patch.take(Pair(12, kIdentity, {0, 0}).first, {90.4F, 80.7F}, 4));
  for (int l = 0; l < patch.levels; ++l) {
    double sum = 0, squares = 0;
    for (const float grey : patch.level[l].grey) sum += grey, squares += double{grey} * grey;
    EXPECT_NEAR(sum, 0, 1e-4);
    EXPECT_NEAR(squares, 1, 1e-4);
    for (int row = 0; row < kPatchSize; ++row) {
      EXPECT_EQ(patch.level[l].grey[row * kPatchStride + kPatchSize], 0);
      EXPECT_EQ(patch.level[l].gx[row * kPatchStride + kPatchSize], 0);
    }
  }
}

}  // namespace
}  // namespace groundloop::slam
