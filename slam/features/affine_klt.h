#pragma once

#include <Eigen/Core>
#include <array>

#include "slam/features/image_pyramid.h"
#include "slam/types/config.h"

namespace groundloop::slam {

/// Options of the affine Lucas-Kanade tracker. YAML: slam.klt
struct KltOptions {
  int levels = 4;              ///< pyramid levels, full resolution included
  int max_iterations = 12;     ///< per level
  double converged_px = 0.02;  ///< a smaller step ends the iteration on the finest level
  double min_ncc = 0.85;       ///< least normalised cross-correlation with the first view
  double max_sigma_px = 0.2;   ///< largest position uncertainty: keeps features from sliding along edges
  double max_scale = 2.0;      ///< det A must stay within [1 / max_scale, max_scale]^2

  template <class Archive>
  void visit(Archive& a) {
    a("levels", levels, {.min = 1, .max = 6});
    a("max_iterations", max_iterations, {.min = 1, .max = 100});
    a("converged_px", converged_px, {.min = 1e-4, .max = 1});
    a("min_ncc", min_ncc, {.min = 0, .max = 1});
    a("max_sigma_px", max_sigma_px, {.min = 0.001, .max = 100});
    a("max_scale", max_scale, {.min = 1, .max = 10});
  }
};

inline constexpr int kPatchSize = 15;  ///< window side [px], odd
inline constexpr int kPatchHalf = kPatchSize / 2;
inline constexpr int kPatchStride = 16;  ///< a row, padded to whole SIMD registers
inline constexpr int kPatchArea = kPatchSize * kPatchStride;
using PatchBuffer = std::array<float, kPatchArea>;

/// One pyramid level of a feature's first view, prepared for inverse-compositional alignment: everything that
/// does not depend on the image to be aligned is computed once.
struct PatchLevel {
  alignas(32) PatchBuffer grey;  ///< mean removed, unit norm; padding is 0
  alignas(32) PatchBuffer gx;    ///< gradients of `grey`; padding is 0
  alignas(32) PatchBuffer gy;
  Eigen::Matrix<float, 6, 1> images,
      grey_images;  ///< sums of the steepest-descent images, alone and times `grey`
  Eigen::Matrix<float, 6, 6> inverse_hessian;  ///< of (translation, affine in units of the half window)
  Eigen::Matrix2f inverse_translation_hessian;
};

/// A feature's first view at all levels.
struct PatchTemplate {
  std::array<PatchLevel, 6> level;
  int levels = 0;  ///< levels in use: those where the window lies inside the image and has texture
  /// Step of position [px of the first view] that an affine alignment takes for a perspective [1 / px]: it
  /// fits the window on average, and where the mapping bends, the centre is not where the average puts it.
  /// Zero until learn_pull(), which only those ask for who know a perspective.
  Eigen::Matrix2f pull = Eigen::Matrix2f::Zero();

  /// Takes the window around (u, v) [level-0 px]. Fails when the window leaves the image at level 0 or has no
  /// texture in two directions.
  bool take(const ImagePyramid& pyramid, const Eigen::Vector2f& uv_px, int max_levels);
  /// Fills `pull` for the window taken last.
  void learn_pull();
};

/// Where a template lies in an image: I_template(x) ~ gain * J(A x / (1 + c x) + uv) + bias.
struct AffineState {
  Eigen::Vector2f uv_px = Eigen::Vector2f::Zero();
  Eigen::Matrix2f A = Eigen::Matrix2f::Identity();
  Eigen::Vector2f c_per_px = Eigen::Vector2f::Zero();  ///< perspective, known from elsewhere: not estimated
  float ncc = 0;                                       ///< normalised cross-correlation reached
  /// Of uv_px, by what is left of the match and the texture of the window: its shape is that of the errors,
  /// its size some eight times too small, as interpolation has smoothed what it is judged by.
  Eigen::Matrix2f covariance_px2 = Eigen::Matrix2f::Zero();
};

enum class KltStatus { kTracked, kOutside, kDegenerate, kPoorMatch };

/// Aligns a template with an image, coarse to fine: translation on the upper levels, affine on the finest,
/// gain and bias free throughout (patches are compared mean-free and of unit norm).
///
/// Inverse compositional: the template's gradients and Hessian are those of the first view; each step p from
/// H^-1 J^T r is inverted and composed, A <- A D^-1, uv <- uv - A (p1, p2) (Baker and
/// Matthews, IJCV 56(3), 2004).
///
/// @param state in: the predicted position and shape; out: the result, valid when kTracked
/// @param start_level  coarsest level to use; with a good prediction 1 is enough
KltStatus track_affine(const PatchTemplate& patch, const ImagePyramid& pyramid, const KltOptions& options,
                       int start_level, AffineState& state);

}  // namespace groundloop::slam
