#include "slam/features/affine_klt.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/features/patch_kernels.h"

namespace groundloop::slam {
namespace {

constexpr float kArea = kPatchSize * kPatchSize;

/// True when every sample of the warped window, padding column and bilinear neighbours included, is in the
/// image.
bool window_inside(const cv::Mat& image, const Eigen::Vector2f& uv, const Eigen::Matrix2f& A) {
  const float reach = kPatchHalf + 1;
  const float du = reach * (std::abs(A(0, 0)) + std::abs(A(0, 1)));
  const float dv = reach * (std::abs(A(1, 0)) + std::abs(A(1, 1)));
  // Written so that NaN is outside.
  return uv.x() - du >= 1 && uv.y() - dv >= 1 && uv.x() + du < static_cast<float>(image.cols - 2) &&
         uv.y() + dv < static_cast<float>(image.rows - 2);
}

/// The same for the region of a first view.
bool region_inside(const cv::Mat& image, const Eigen::Vector2f& uv) {
  constexpr float kReach = kRegionSize / 2 + 1, kPadded = kRegionStride - kRegionSize / 2 + 1;
  return uv.x() >= kReach && uv.y() >= kReach && uv.x() + kPadded < static_cast<float>(image.cols) &&
         uv.y() + kReach + 1 < static_cast<float>(image.rows);
}

void warp(const cv::Mat& image, const Eigen::Vector2f& uv, const Eigen::Matrix2f& A, float* patch) {
  const float a[4] = {A(0, 0), A(0, 1), A(1, 0), A(1, 1)};
  warp_patch(image.ptr<int16_t>(), static_cast<ptrdiff_t>(image.step1()), uv.x(), uv.y(), a, patch);
}

struct Normalisation {
  float mean, scale;
};

/// Mean and inverse norm of a window by its sums; the scale is 0 when the window is flat.
Normalisation normalisation_of(float sum, float squares) {
  const float mean = sum / kArea;
  const float energy = squares - sum * mean;
  // Below one grey level rms there is nothing but noise to align.
  const float least = kArea * ImagePyramid::kScale * ImagePyramid::kScale;
  return {mean, energy > least ? 1 / std::sqrt(energy) : 0};
}

/// Hessian of (translation, affine), with the mean of each steepest-descent image taken off: the bias is
/// free, so only what differs from the mean informs.
Eigen::Matrix<float, 6, 6> hessian_of(const GradientMoments& m, const Eigen::Matrix<float, 6, 1>& images) {
  // rows and columns: gx, gy, x gx, y gx, x gy, y gy; moments: 1, x, y, xx, xy, yy
  Eigen::Matrix<float, 6, 6> H;
  H << m.xx[0], m.xy[0], m.xx[1], m.xx[2], m.xy[1], m.xy[2],  //
      m.xy[0], m.yy[0], m.xy[1], m.xy[2], m.yy[1], m.yy[2],   //
      m.xx[1], m.xy[1], m.xx[3], m.xx[4], m.xy[3], m.xy[4],   //
      m.xx[2], m.xy[2], m.xx[4], m.xx[5], m.xy[4], m.xy[5],   //
      m.xy[1], m.yy[1], m.xy[3], m.xy[4], m.yy[3], m.yy[4],   //
      m.xy[2], m.yy[2], m.xy[4], m.xy[5], m.yy[4], m.yy[5];
  return H - images * images.transpose() / kArea;
}

/// Values, gradients and Hessians of one level; false when the window is flat or has texture in one direction
/// only.
bool prepare_level(const cv::Mat& image, const Eigen::Vector2f& uv, PatchLevel& level) {
  if (!region_inside(image, uv)) return false;
  alignas(32) std::array<float, kRegionSize * kRegionStride> region;
  sample_region(image.ptr<int16_t>(), static_cast<ptrdiff_t>(image.step1()), uv.x(), uv.y(), region.data());
  for (int row = 0; row < kPatchSize; ++row) {
    std::copy_n(region.data() + (row + 1) * kRegionStride + 1, kPatchStride,
                level.grey.data() + row * kPatchStride);
  }
  float sum, squares;
  patch_moments(level.grey.data(), &sum, &squares);
  const Normalisation n = normalisation_of(sum, squares);
  if (n.scale == 0) return false;
  for (int i = 0; i < kPatchArea; ++i) {
    level.grey[i] = i % kPatchStride < kPatchSize ? (level.grey[i] - n.mean) * n.scale : 0;
  }
  region_gradients(region.data(), n.scale, level.gx.data(), level.gy.data());

  GradientMoments moments;
  gradient_moments(level.gx.data(), level.gy.data(), &moments);
  level.images << moments.gx[0], moments.gy[0], moments.gx[1], moments.gx[2], moments.gy[1], moments.gy[2];
  PatchSums own;
  patch_sums(level.grey.data(), 0, level.grey.data(), level.gx.data(), level.gy.data(), &own);
  level.grey_images = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(own.images);
  Eigen::Matrix<float, 6, 6> H = hessian_of(moments, level.images);
  // A weak pull towards the predicted shape keeps windows with little texture from collapsing.
  for (int k = 2; k < 6; ++k) H(k, k) += 0.01F * (H(0, 0) + H(1, 1));

  const Eigen::Matrix2f H_translation = H.topLeftCorner<2, 2>();
  const float trace = H_translation.trace();
  if (!(H_translation.determinant() > 1e-4F * trace * trace)) return false;
  level.inverse_translation_hessian = H_translation.inverse();
  level.inverse_hessian = H.ldlt().solve(Eigen::Matrix<float, 6, 6>::Identity());
  return true;
}

/// Gauss-Newton on one level. Positions are in pixels of that level.
KltStatus align_level(const PatchLevel& level, const cv::Mat& image, const KltOptions& options, bool affine,
                      AffineState& state) {
  // A coarse level only has to bring the next one near enough.
  const double converged_px = affine ? options.converged_px : std::max(options.converged_px, 0.1);
  alignas(32) PatchBuffer patch;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (!window_inside(image, state.uv_px, state.A)) return KltStatus::kOutside;
    warp(image, state.uv_px, state.A, patch.data());
    PatchSums sums;
    patch_sums(patch.data(), patch[kPatchArea / 2], level.grey.data(), level.gx.data(), level.gy.data(),
               &sums);
    const Normalisation n = normalisation_of(sums.sum, sums.squares);
    if (n.scale == 0) return KltStatus::kPoorMatch;
    state.ncc = n.scale * sums.grey;

    // Of the residual (patch - mean) * scale - grey.
    const Eigen::Matrix<float, 6, 1> products =
        n.scale * (Eigen::Map<const Eigen::Matrix<float, 6, 1>>(sums.images) - n.mean * level.images) -
        level.grey_images;
    Eigen::Vector2f step;
    if (affine) {
      const Eigen::Matrix<float, 6, 1> p = level.inverse_hessian * products;
      Eigen::Matrix2f D;
      D << p(2), p(3), p(4), p(5);
      D = D / kPatchHalf + Eigen::Matrix2f::Identity();
      const float determinant = D.determinant();
      if (!(determinant > 0.2F)) return KltStatus::kDegenerate;
      state.A = state.A * D.inverse();
      step = state.A * p.head<2>();
      const float area = state.A.determinant();
      const auto limit = static_cast<float>(options.max_scale * options.max_scale);
      if (!(area < limit && area > 1 / limit)) return KltStatus::kDegenerate;
    } else {
      step = state.A * (level.inverse_translation_hessian * products.head<2>());
    }
    state.uv_px -= step;
    if (step.squaredNorm() < converged_px * converged_px) break;
  }
  return KltStatus::kTracked;
}

/// What the match itself says of its precision: its residual, 2 (1 - ncc) over the window as both patches
/// have unit norm, is the noise; the Hessian turns it into a covariance of position with shape and brightness
/// left free.
Eigen::Matrix2f position_covariance_px2(const PatchLevel& level, const AffineState& state) {
  const float variance = 2 * std::max(0.0F, 1 - state.ncc) / kArea;
  return variance * (state.A * level.inverse_hessian.topLeftCorner<2, 2>() * state.A.transpose());
}

/// Of the least certain direction.
float largest_variance(const Eigen::Matrix2f& C) {
  const float half_trace = 0.5F * C.trace();
  return half_trace + std::sqrt(std::max(0.0F, half_trace * half_trace - C.determinant()));
}

}  // namespace

bool PatchTemplate::take(const ImagePyramid& pyramid, const Eigen::Vector2f& uv_px, int max_levels) {
  levels = 0;
  const int wanted = std::min({max_levels, pyramid.levels(), static_cast<int>(level.size())});
  for (int l = 0; l < wanted; ++l) {
    if (!prepare_level(pyramid.level(l), uv_px / static_cast<float>(1 << l), level[l])) break;
    levels = l + 1;
  }
  pull.setZero();
  return levels > 0;
}

/// The second order of a perspective, -A x (c x), as the alignment of an affine map sees it: the step in
/// position that answers it, per unit of c.
void PatchTemplate::learn_pull() {
  const PatchLevel& finest = level[0];
  Eigen::Matrix<float, 6, 2> products = Eigen::Matrix<float, 6, 2>::Zero();
  Eigen::RowVector2f sum = Eigen::RowVector2f::Zero();
  for (int row = 0; row < kPatchSize; ++row) {
    for (int col = 0; col < kPatchSize; ++col) {
      const int i = row * kPatchStride + col;
      const Eigen::RowVector2f x(static_cast<float>(col - kPatchHalf), static_cast<float>(row - kPatchHalf));
      const float gx = finest.gx[i], gy = finest.gy[i];
      const Eigen::RowVector2f change = (gx * x.x() + gy * x.y()) * x;
      const Eigen::RowVector2f half = x / kPatchHalf;
      Eigen::Matrix<float, 6, 1> images;
      images << gx, gy, half.x() * gx, half.y() * gx, half.x() * gy, half.y() * gy;
      products += images * change;
      sum += change;
    }
  }
  products -= finest.images * sum / kArea;
  pull = (finest.inverse_hessian * products).topRows<2>();
}

KltStatus track_affine(const PatchTemplate& patch, const ImagePyramid& pyramid, const KltOptions& options,
                       int start_level, AffineState& state) {
  if (patch.levels == 0) return KltStatus::kDegenerate;
  for (int l = std::min(start_level, patch.levels - 1); l >= 0; --l) {
    const auto factor = static_cast<float>(1 << l);
    AffineState at_level = state;
    at_level.uv_px /= factor;
    const KltStatus status = align_level(patch.level[l], pyramid.level(l), options, l == 0, at_level);
    // A coarse window that leaves the image, or has nothing to hold on to, says nothing of the finer ones.
    if (l > 0 && status != KltStatus::kTracked) continue;
    if (status != KltStatus::kTracked) return status;
    state = at_level;
    state.uv_px *= factor;
  }
  state.covariance_px2 = position_covariance_px2(patch.level[0], state);
  state.uv_px += state.A * (patch.pull * state.c_per_px);
  const auto max_sigma_px = static_cast<float>(options.max_sigma_px);
  const bool good =
      state.ncc >= options.min_ncc && largest_variance(state.covariance_px2) <= max_sigma_px * max_sigma_px;
  return good ? KltStatus::kTracked : KltStatus::kPoorMatch;
}

}  // namespace groundloop::slam
