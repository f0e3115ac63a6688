#include "slam/features/affine_klt.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
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

void warp(const cv::Mat& image, const Eigen::Vector2f& uv, const Eigen::Matrix2f& A, float* patch) {
  const float a[4] = {A(0, 0), A(0, 1), A(1, 0), A(1, 1)};
  warp_patch(image.ptr<int16_t>(), static_cast<ptrdiff_t>(image.step1()), uv.x(), uv.y(), a, patch);
}

struct Normalisation {
  float mean, scale;
};

/// Mean and inverse norm of a window; the scale is 0 when the window is flat.
Normalisation normalisation_of(const float* patch) {
  float sum, squares;
  patch_moments(patch, &sum, &squares);
  const float mean = sum / kArea;
  const float energy = squares - sum * mean;
  // Below one grey level rms there is nothing but noise to align.
  const float least = kArea * ImagePyramid::kScale * ImagePyramid::kScale;
  return {mean, energy > least ? 1 / std::sqrt(energy) : 0};
}

/// Gradients and Hessians of one level; false when the window is flat or has texture in one direction only.
bool prepare_level(const cv::Mat& image, const Eigen::Vector2f& uv, PatchLevel& level) {
  const Eigen::Matrix2f identity = Eigen::Matrix2f::Identity();
  if (!window_inside(image, uv, 1.3F * identity)) return false;
  alignas(32) PatchBuffer raw, left, right, up, down;
  warp(image, uv, identity, raw.data());
  warp(image, uv - Eigen::Vector2f(1, 0), identity, left.data());
  warp(image, uv + Eigen::Vector2f(1, 0), identity, right.data());
  warp(image, uv - Eigen::Vector2f(0, 1), identity, up.data());
  warp(image, uv + Eigen::Vector2f(0, 1), identity, down.data());
  const Normalisation n = normalisation_of(raw.data());
  if (n.scale == 0) return false;

  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (int row = 0; row < kPatchSize; ++row) {
    for (int col = 0; col < kPatchStride; ++col) {
      const int i = row * kPatchStride + col;
      const bool inside = col < kPatchSize;
      level.grey[i] = inside ? (raw[i] - n.mean) * n.scale : 0;
      level.gx[i] = inside ? 0.5F * (right[i] - left[i]) * n.scale : 0;
      level.gy[i] = inside ? 0.5F * (down[i] - up[i]) * n.scale : 0;
      const double x = static_cast<double>(col - kPatchHalf) / kPatchHalf;
      const double y = static_cast<double>(row - kPatchHalf) / kPatchHalf;
      Eigen::Matrix<double, 6, 1> J;
      J << level.gx[i], level.gy[i], x * level.gx[i], y * level.gx[i], x * level.gy[i], y * level.gy[i];
      H += J * J.transpose();
      mean += J;
    }
  }
  H -= mean * mean.transpose() / kArea;  // the bias is free: only what differs from the mean informs
  // A weak pull towards the predicted shape keeps windows with little texture from collapsing.
  for (int k = 2; k < 6; ++k) H(k, k) += 0.01 * (H(0, 0) + H(1, 1));

  const Eigen::Matrix2d H_translation = H.topLeftCorner<2, 2>();
  const double trace = H_translation.trace();
  if (!(H_translation.determinant() > 1e-4 * trace * trace)) return false;
  level.inverse_translation_hessian = H_translation.inverse().cast<float>();
  level.inverse_hessian = H.ldlt().solve(Eigen::Matrix<double, 6, 6>::Identity()).cast<float>();
  return true;
}

/// Gauss-Newton on one level. Positions are in pixels of that level.
KltStatus align_level(const PatchLevel& level, const cv::Mat& image, const KltOptions& options, bool affine,
                      AffineState& state) {
  alignas(32) PatchBuffer patch;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (!window_inside(image, state.uv_px, state.A)) return KltStatus::kOutside;
    warp(image, state.uv_px, state.A, patch.data());
    const Normalisation n = normalisation_of(patch.data());
    if (n.scale == 0) return KltStatus::kPoorMatch;

    Eigen::Matrix<float, 6, 1> products;
    patch_products(patch.data(), n.mean, n.scale, level.grey.data(), level.gx.data(), level.gy.data(),
                   products.data(), &state.ncc);
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
    if (step.squaredNorm() < options.converged_px * options.converged_px) break;
  }
  return KltStatus::kTracked;
}

}  // namespace

bool PatchTemplate::take(const ImagePyramid& pyramid, const Eigen::Vector2f& uv_px, int max_levels) {
  levels = 0;
  const int wanted = std::min({max_levels, pyramid.levels(), static_cast<int>(level.size())});
  for (int l = 0; l < wanted; ++l) {
    if (!prepare_level(pyramid.level(l), uv_px / static_cast<float>(1 << l), level[l])) break;
    levels = l + 1;
  }
  return levels > 0;
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
  return state.ncc >= options.min_ncc ? KltStatus::kTracked : KltStatus::kPoorMatch;
}

}  // namespace groundloop::slam
