#pragma once

#include <cstddef>
#include <cstdint>

namespace groundloop::slam {

/// Samples a kPatchSize x kPatchStride window of a 16-bit image, bilinearly, at A x + (u, v) for x in
/// [-kPatchHalf, kPatchHalf]^2. The caller makes sure that all samples and their right and lower neighbours,
/// those of the padding column included, lie in the image.
/// @param stride row pitch of the image [elements]
void warp_patch(const int16_t* image, ptrdiff_t stride, float u, float v, const float A[4], float* patch);

/// Sum and sum of squares over the window (padding left out).
void patch_moments(const float* patch, float* sum, float* sum_of_squares);

/// Residual r = (patch - mean) * scale - grey and its products with the six steepest-descent images, in units
/// of the half window: sum r (gx, gy, x gx, y gx, x gy, y gy). Also the correlation of patch and grey.
void patch_products(const float* patch, float mean, float scale, const float* grey, const float* gx,
                    const float* gy, float products[6], float* correlation);

}  // namespace groundloop::slam
