// The fast loops against plain ones in double precision.
#include "slam/features/patch_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "slam/features/affine_klt.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr int kSide = 80;

struct RandomImage {
  explicit RandomImage(uint64_t seed) {
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = static_cast<int16_t>(random_index(random_bits(seed, 7, i), 4081));
    }
  }
  double bilinear(double u, double v) const {
    const int iu = static_cast<int>(std::floor(u)), iv = static_cast<int>(std::floor(v));
    const double fu = u - iu, fv = v - iv;
    const auto at = [&](int x, int y) { return static_cast<double>(pixels[y * kSide + x]); };
    return (1 - fv) * ((1 - fu) * at(iu, iv) + fu * at(iu + 1, iv)) +
           fv * ((1 - fu) * at(iu, iv + 1) + fu * at(iu + 1, iv + 1));
  }
  std::array<int16_t, kSide * kSide> pixels;
};

std::array<float, kPatchArea> random_patch(uint64_t seed, bool zero_padding) {
  std::array<float, kPatchArea> patch;
  for (int i = 0; i < kPatchArea; ++i) {
    const bool padding = i % kPatchStride >= kPatchSize;
    patch[i] = padding && zero_padding
                   ? 0
                   : static_cast<float>(gaussian(seed, 1, static_cast<uint64_t>(i)) * 0.07 + 0.01);
  }
  return patch;
}

/// Calls f(index into the patch, x, y) over the window, x and y in pixels from its middle.
template <class F>
void over_window(F f) {
  for (int y = -kPatchHalf; y <= kPatchHalf; ++y) {
    for (int x = -kPatchHalf; x <= kPatchHalf; ++x) f((y + kPatchHalf) * kPatchStride + x + kPatchHalf, x, y);
  }
}

class WarpPatch : public testing::TestWithParam<std::array<float, 4>> {};

TEST_P(WarpPatch, SamplesBilinearlyWhereTheWarpPoints) {
  const std::array<float, 4> A = GetParam();
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomImage image(seed);
    const auto u = static_cast<float>(30 + 20 * uniform(seed, 1, 0));
    const auto v = static_cast<float>(30 + 20 * uniform(seed, 2, 0));
    std::array<float, kPatchArea> patch;
    warp_patch(image.pixels.data(), kSide, u, v, A.data(), patch.data());
    over_window([&](int i, int x, int y) {
      // A coordinate near 50 has a float step of 4e-6 px; 4080 levels of contrast make 0.03 of some of them.
      EXPECT_NEAR(patch[i], image.bilinear(u + A[0] * x + A[1] * y, v + A[2] * x + A[3] * y), 0.1);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Warps, WarpPatch,
                         testing::Values(std::array<float, 4>{1, 0, 0, 1},                // identity
                                         std::array<float, 4>{0.8F, -0.6F, 0.6F, 0.8F},   // rotation
                                         std::array<float, 4>{1.5F, 0, 0, 1.5F},          // scale
                                         std::array<float, 4>{0.6F, 0, 0, 0.6F},          // shrinking
                                         std::array<float, 4>{1.1F, 0.2F, -0.15F, 0.9F},  // any
                                         std::array<float, 4>{-1, 0, 0, -1}));            // half a turn

TEST(WarpPatch, AtWholePixelsIsTheImageItself) {
  const RandomImage image(3);
  const float identity[4] = {1, 0, 0, 1};
  std::array<float, kPatchArea> patch;
  warp_patch(image.pixels.data(), kSide, 40, 33, identity, patch.data());
  over_window([&](int i, int x, int y) { EXPECT_EQ(patch[i], image.pixels[(33 + y) * kSide + 40 + x]); });
}

TEST(SampleRegion, SamplesBilinearlyAroundThePoint) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomImage image(seed);
    const auto u = static_cast<float>(20 + 25 * uniform(seed, 1, 0));
    const auto v = static_cast<float>(20 + 25 * uniform(seed, 2, 0));
    std::array<float, kRegionSize * kRegionStride> region;
    sample_region(image.pixels.data(), kSide, u, v, region.data());
    for (int y = -8; y <= 8; ++y) {
      for (int x = -8; x <= 8; ++x) {
        EXPECT_NEAR(region[(y + 8) * kRegionStride + x + 8], image.bilinear(double{u} + x, double{v} + y),
                    0.1);
      }
    }
  }
}

TEST(RegionGradients, AreCentralDifferencesWithEmptyPadding) {
  std::array<float, kRegionSize * kRegionStride> region;
  for (size_t i = 0; i < region.size(); ++i) region[i] = static_cast<float>(4080 * uniform(5, 1, i));
  alignas(32) PatchBuffer gx, gy;
  const float scale = 0.25F;
  region_gradients(region.data(), scale, gx.data(), gy.data());
  const auto at = [&](int x, int y) { return double{region[(y + 8) * kRegionStride + x + 8]}; };
  over_window([&](int i, int x, int y) {
    EXPECT_NEAR(gx[i], 0.25 * (at(x + 1, y) - at(x - 1, y)) / 2, 1e-3);
    EXPECT_NEAR(gy[i], 0.25 * (at(x, y + 1) - at(x, y - 1)) / 2, 1e-3);
  });
  for (int row = 0; row < kPatchSize; ++row) {
    EXPECT_EQ(gx[row * kPatchStride + kPatchSize], 0);
    EXPECT_EQ(gy[row * kPatchStride + kPatchSize], 0);
  }
}

TEST(GradientMoments, EqualThePlainSums) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto gx = random_patch(seed, true), gy = random_patch(seed + 100, true);
    GradientMoments moments;
    gradient_moments(gx.data(), gy.data(), &moments);
    double xx[6] = {}, xy[6] = {}, yy[6] = {}, mx[3] = {}, my[3] = {};
    over_window([&](int i, int column, int line) {
      const double x = column / double{kPatchHalf}, y = line / double{kPatchHalf};
      const double monomial[6] = {1, x, y, x * x, x * y, y * y};
      for (int k = 0; k < 6; ++k) {
        xx[k] += double{gx[i]} * gx[i] * monomial[k];
        xy[k] += double{gx[i]} * gy[i] * monomial[k];
        yy[k] += double{gy[i]} * gy[i] * monomial[k];
      }
      for (int k = 0; k < 3; ++k) {
        mx[k] += gx[i] * monomial[k];
        my[k] += gy[i] * monomial[k];
      }
    });
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(moments.xx[k], xx[k], 2e-6);
      EXPECT_NEAR(moments.xy[k], xy[k], 2e-6);
      EXPECT_NEAR(moments.yy[k], yy[k], 2e-6);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(moments.gx[k], mx[k], 2e-5);
      EXPECT_NEAR(moments.gy[k], my[k], 2e-5);
    }
  }
}

TEST(PatchMoments, LeaveThePaddingOut) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto patch = random_patch(seed, false);
    float sum, squares;
    patch_moments(patch.data(), &sum, &squares);
    double expected_sum = 0, expected_squares = 0;
    over_window([&](int i, int, int) {
      expected_sum += patch[i];
      expected_squares += double{patch[i]} * patch[i];
    });
    EXPECT_NEAR(sum, expected_sum, 1e-5);
    EXPECT_NEAR(squares, expected_squares, 1e-5);
  }
}

TEST(PatchSums, EqualThePlainSumsWithoutThePadding) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto patch = random_patch(seed, false);
    const auto grey = random_patch(seed + 50, true), gx = random_patch(seed + 100, true),
               gy = random_patch(seed + 150, true);
    const float offset = 0.02F;
    PatchSums sums;
    patch_sums(patch.data(), offset, grey.data(), gx.data(), gy.data(), &sums);
    double sum = 0, squares = 0, correlation = 0, expected[6] = {};
    over_window([&](int i, int column, int line) {
      const double x = column / double{kPatchHalf}, y = line / double{kPatchHalf};
      const double p = double{patch[i]} - offset;
      const double images[6] = {gx[i], gy[i], x * gx[i], y * gx[i], x * gy[i], y * gy[i]};
      for (int k = 0; k < 6; ++k) expected[k] += p * images[k];
      sum += p;
      squares += p * p;
      correlation += p * grey[i];
    });
    EXPECT_NEAR(sums.sum, sum, 1e-5);
    EXPECT_NEAR(sums.squares, squares, 1e-5);
    EXPECT_NEAR(sums.grey, correlation, 2e-6);
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(sums.images[k], expected[k], 2e-6);
  }
}

}  // namespace
}  // namespace groundloop::slam
