#pragma once

#include <cstddef>
#include <cstdint>

namespace groundloop::slam {

/// Samples a kPatchSize x kPatchStride window of a 16-bit image, bilinearly, at A x + (u, v) for x in
/// [-kPatchHalf, kPatchHalf]^2. The caller makes sure that all samples and their right and lower neighbours,
/// those of the padding column included, lie in the image.
/// @param stride row pitch of the image [elements]
void warp_patch(const int16_t* image, ptrdiff_t stride, float u, float v, const float A[4], float* patch);

inline constexpr int kRegionSize = 17;  ///< the window and one pixel around it
inline constexpr int kRegionStride = 24;

/// Samples a kRegionSize x kRegionSize window, bilinearly, at (u, v) + {-8..8}^2: what a first view needs for
/// its values and gradients. The caller makes sure that the samples and their right and lower neighbours,
/// those of the padding columns included, lie in the image.
void sample_region(const int16_t* image, ptrdiff_t stride, float u, float v, float* region);

/// Central differences of a region over the window; the padding is 0.
void region_gradients(const float* region, float scale, float* gx, float* gy);

/// Sums over the window of {gx gx, gx gy, gy gy} times {1, x, y, x x, x y, y y}, and of {gx, gy} times {1, x,
/// y}, with x and y in units of the half window: all that the Hessian of an affine alignment is made of.
struct GradientMoments {
  float xx[6], xy[6], yy[6];
  float gx[3], gy[3];
};
void gradient_moments(const float* gx, const float* gy, GradientMoments* moments);

/// Sum and sum of squares over the window (padding left out).
void patch_moments(const float* patch, float* sum, float* sum_of_squares);

/// Sums over the window of p = patch - offset: alone, squared, times a template's grey values, and times its
/// six steepest-descent images gx, gy, x gx, y gx, x gy, y gy with x and y in units of the half window. All
/// that a step of an alignment is made of, whatever the mean and the contrast of the patch turn out to be.
struct PatchSums {
  float sum, squares;
  float grey;
  float images[6];
};
/// @param offset  near the mean: keeps the sums exact
/// @param grey, gx, gy  0 in the padding
void patch_sums(const float* patch, float offset, const float* grey, const float* gx, const float* gy,
                PatchSums* sums);

}  // namespace groundloop::slam
