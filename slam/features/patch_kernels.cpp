#include "slam/features/patch_kernels.h"

#include "slam/features/affine_klt.h"
#include "slam/features/multiversion.h"

namespace groundloop::slam {
namespace {

constexpr int kLanes =
    8;  // independent sums, so that the compiler may use vector registers without reordering
static_assert(kPatchStride == 2 * kLanes);

/// Two horizontally neighbouring 16-bit pixels read at once; pixels are only 2-byte aligned.
typedef int32_t __attribute__((aligned(2), may_alias)) PixelPair;

inline float sum_of(const float* lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

/// 1 for the window's columns, 0 for the padding one.
alignas(32) constexpr float kInside[kPatchStride] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
alignas(32) constexpr float kX[kPatchStride] = {-7, -6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7, 8};

}  // namespace

GROUNDLOOP_MULTIVERSION
void warp_patch(const int16_t* image, ptrdiff_t stride, float u, float v, const float A[4], float* patch) {
  const int pitch = static_cast<int>(stride);
  for (int row = 0; row < kPatchSize; ++row) {
    const auto y = static_cast<float>(row - kPatchHalf);
    const float u_row = u + A[1] * y, v_row = v + A[3] * y;
    float* out = patch + row * kPatchStride;
    for (int i = 0; i < kPatchStride; ++i) {
      const float uu = u_row + A[0] * kX[i], vv = v_row + A[2] * kX[i];
      const int iu = static_cast<int>(uu), iv = static_cast<int>(vv);
      const float fu = uu - static_cast<float>(iu), fv = vv - static_cast<float>(iv);
      const int offset = iv * pitch + iu;
      const int32_t top = *reinterpret_cast<const PixelPair*>(image + offset);
      const int32_t bottom = *reinterpret_cast<const PixelPair*>(image + offset + pitch);
      const auto top_left = static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(top) << 16) >> 16);
      const auto bottom_left =
          static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(bottom) << 16) >> 16);
      const float upper = top_left + fu * (static_cast<float>(top >> 16) - top_left);
      const float lower = bottom_left + fu * (static_cast<float>(bottom >> 16) - bottom_left);
      out[i] = upper + fv * (lower - upper);
    }
  }
}

GROUNDLOOP_MULTIVERSION
void patch_moments(const float* patch, float* sum, float* sum_of_squares) {
  float s[kLanes] = {}, q[kLanes] = {};
  for (int row = 0; row < kPatchSize; ++row) {
    for (int half = 0; half < kPatchStride; half += kLanes) {
      for (int i = 0; i < kLanes; ++i) {
        const float value = patch[row * kPatchStride + half + i] * kInside[half + i];
        s[i] += value;
        q[i] += value * value;
      }
    }
  }
  *sum = sum_of(s);
  *sum_of_squares = sum_of(q);
}

GROUNDLOOP_MULTIVERSION
void patch_products(const float* patch, float mean, float scale, const float* grey, const float* gx,
                    const float* gy, float products[6], float* correlation) {
  float s[6][kLanes] = {}, c[kLanes] = {};
  for (int row = 0; row < kPatchSize; ++row) {
    const float y = static_cast<float>(row - kPatchHalf) / kPatchHalf;
    for (int half = 0; half < kPatchStride; half += kLanes) {
      const int at = row * kPatchStride + half;
      for (int i = 0; i < kLanes; ++i) {
        const float x = kX[half + i] * (1.0F / kPatchHalf);
        const float value = (patch[at + i] - mean) * scale;
        const float r = value - grey[at + i];
        const float rx = r * gx[at + i], ry = r * gy[at + i];  // gradients are 0 in the padding
        c[i] += value * grey[at + i];
        s[0][i] += rx;
        s[1][i] += ry;
        s[2][i] += rx * x;
        s[3][i] += rx * y;
        s[4][i] += ry * x;
        s[5][i] += ry * y;
      }
    }
  }
  for (int k = 0; k < 6; ++k) products[k] = sum_of(s[k]);
  *correlation = sum_of(c);
}

}  // namespace groundloop::slam
