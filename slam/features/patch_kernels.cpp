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

inline float low_pixel(int32_t pair) {
  return static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(pair) << 16) >> 16);
}
inline float high_pixel(int32_t pair) { return static_cast<float>(pair >> 16); }

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
  const float a00 = A[0], a01 = A[1], a10 = A[2], a11 = A[3];
  for (int row = 0; row < kPatchSize; ++row) {
    const auto y = static_cast<float>(row - kPatchHalf);
    const float u_row = u + a01 * y, v_row = v + a11 * y;
    float* out = patch + row * kPatchStride;
    // Three short loops, so that only the loads in the middle are one by one.
    alignas(32) int offset[kPatchStride];
    alignas(32) float fu[kPatchStride], fv[kPatchStride];
#pragma GCC unroll 1  // unrolled whole, it would not be vectorised
    for (int i = 0; i < kPatchStride; ++i) {
      const auto x = static_cast<float>(i - kPatchHalf);
      const float uu = u_row + a00 * x, vv = v_row + a10 * x;
      const int iu = static_cast<int>(uu), iv = static_cast<int>(vv);
      fu[i] = uu - static_cast<float>(iu);
      fv[i] = vv - static_cast<float>(iv);
      offset[i] = iv * pitch + iu;
    }
    alignas(32) int32_t top[kPatchStride], bottom[kPatchStride];
    for (int i = 0; i < kPatchStride; ++i) {
      top[i] = *reinterpret_cast<const PixelPair*>(image + offset[i]);
      bottom[i] = *reinterpret_cast<const PixelPair*>(image + offset[i] + pitch);
    }
    for (int i = 0; i < kPatchStride; ++i) {
      const float top_left = low_pixel(top[i]), bottom_left = low_pixel(bottom[i]);
      const float upper = top_left + fu[i] * (high_pixel(top[i]) - top_left);
      const float lower = bottom_left + fu[i] * (high_pixel(bottom[i]) - bottom_left);
      out[i] = upper + fv[i] * (lower - upper);
    }
  }
}

GROUNDLOOP_MULTIVERSION
void sample_region(const int16_t* image, ptrdiff_t stride, float u, float v, float* region) {
  const int iu = static_cast<int>(u), iv = static_cast<int>(v);
  const float fu = u - static_cast<float>(iu), fv = v - static_cast<float>(iv);
  const float w00 = (1 - fu) * (1 - fv), w01 = fu * (1 - fv), w10 = (1 - fu) * fv, w11 = fu * fv;
  for (int row = 0; row < kRegionSize; ++row) {
    const int16_t* top = image + (iv + row - kRegionSize / 2) * stride + iu - kRegionSize / 2;
    const int16_t* bottom = top + stride;
    float* out = region + row * kRegionStride;
    for (int i = 0; i < kRegionStride; ++i) {
      out[i] = w00 * top[i] + w01 * top[i + 1] + w10 * bottom[i] + w11 * bottom[i + 1];
    }
  }
}

GROUNDLOOP_MULTIVERSION
void region_gradients(const float* region, float scale, float* gx, float* gy) {
  for (int row = 0; row < kPatchSize; ++row) {
    const float* above = region + row * kRegionStride + 1;
    const float* here = above + kRegionStride;
    const float* below = here + kRegionStride;
    for (int i = 0; i < kPatchStride; ++i) {
      gx[row * kPatchStride + i] = 0.5F * scale * kInside[i] * (here[i + 1] - here[i - 1]);
      gy[row * kPatchStride + i] = 0.5F * scale * kInside[i] * (below[i] - above[i]);
    }
  }
}

GROUNDLOOP_MULTIVERSION
void gradient_moments(const float* gx, const float* gy, GradientMoments* moments) {
  // Sums over the columns first: y is the same for a whole row.
  float sums[13][kLanes];
  double total[24] = {};
  for (int row = 0; row < kPatchSize; ++row) {
    for (auto& lanes : sums) {
      for (float& lane : lanes) lane = 0;
    }
    for (int half = 0; half < kPatchStride; half += kLanes) {
      const int at = row * kPatchStride + half;
      for (int i = 0; i < kLanes; ++i) {
        const float x = kX[half + i] * (1.0F / kPatchHalf);
        const float a = gx[at + i], b = gy[at + i];
        const float aa = a * a, ab = a * b, bb = b * b;
        sums[0][i] += aa, sums[1][i] += aa * x, sums[2][i] += aa * x * x;
        sums[3][i] += ab, sums[4][i] += ab * x, sums[5][i] += ab * x * x;
        sums[6][i] += bb, sums[7][i] += bb * x, sums[8][i] += bb * x * x;
        sums[9][i] += a, sums[10][i] += a * x;
        sums[11][i] += b, sums[12][i] += b * x;
      }
    }
    const double y = static_cast<double>(row - kPatchHalf) / kPatchHalf;
    for (int g = 0; g < 3; ++g) {
      const double s = sum_of(sums[3 * g]), sx = sum_of(sums[3 * g + 1]), sxx = sum_of(sums[3 * g + 2]);
      double* t = total + 6 * g;
      t[0] += s, t[1] += sx, t[2] += s * y, t[3] += sxx, t[4] += sx * y, t[5] += s * y * y;
    }
    for (int g = 0; g < 2; ++g) {
      const double s = sum_of(sums[9 + 2 * g]), sx = sum_of(sums[10 + 2 * g]);
      double* t = total + 18 + 3 * g;
      t[0] += s, t[1] += sx, t[2] += s * y;
    }
  }
  for (int k = 0; k < 6; ++k) {
    moments->xx[k] = static_cast<float>(total[k]);
    moments->xy[k] = static_cast<float>(total[6 + k]);
    moments->yy[k] = static_cast<float>(total[12 + k]);
  }
  for (int k = 0; k < 3; ++k) {
    moments->gx[k] = static_cast<float>(total[18 + k]);
    moments->gy[k] = static_cast<float>(total[21 + k]);
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
void patch_sums(const float* patch, float offset, const float* grey, const float* gx, const float* gy,
                PatchSums* sums) {
  float s[6][kLanes] = {}, c[kLanes] = {}, p[kLanes] = {}, q[kLanes] = {};
  for (int row = 0; row < kPatchSize; ++row) {
    const float y = static_cast<float>(row - kPatchHalf) / kPatchHalf;
    for (int half = 0; half < kPatchStride; half += kLanes) {
      const int at = row * kPatchStride + half;
      for (int i = 0; i < kLanes; ++i) {
        const float x = kX[half + i] * (1.0F / kPatchHalf);
        const float value = (patch[at + i] - offset) * kInside[half + i];
        const float px = value * gx[at + i], py = value * gy[at + i];
        p[i] += value;
        q[i] += value * value;
        c[i] += value * grey[at + i];
        s[0][i] += px;
        s[1][i] += py;
        s[2][i] += px * x;
        s[3][i] += px * y;
        s[4][i] += py * x;
        s[5][i] += py * y;
      }
    }
  }
  sums->sum = sum_of(p);
  sums->squares = sum_of(q);
  sums->grey = sum_of(c);
  for (int k = 0; k < 6; ++k) sums->images[k] = sum_of(s[k]);
}

}  // namespace groundloop::slam
