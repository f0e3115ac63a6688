#include "slam/stereo/matcher.h"

#include <cmath>

namespace groundloop::slam {
namespace {

// Measured against exact tracks in rendered rooms (docs/decisions/0021-a-match-counts-by-its-precision.md).
constexpr double kTypical_px = 0.07;  // what a match says of itself that errs by the stated deviation
constexpr double kLeast = 0.4;        // error of the best matches, relative to the stated deviation
constexpr double kSameInBoth = 0.25;  // correlation of the errors in the two images

}  // namespace

std::optional<AffineState> StereoMatcher::match(const PatchTemplate& patch, const AffineState& left,
                                                const DenseDisparity& dense, const ImagePyramid& right,
                                                const RightLag& lag) const {
  const std::optional<float> disparity_px = dense.around(left.uv_px.x(), left.uv_px.y());
  if (!disparity_px) return std::nullopt;

  AffineState state = left;
  state.uv_px.x() -= *disparity_px;
  if (const auto p_left = rig_.triangulate({left.uv_px.x(), left.uv_px.y(), state.uv_px.x()})) {
    state.uv_px += lag.shift_px(rig_, *p_left);
  }
  const Eigen::Vector2f predicted_px = state.uv_px;
  if (track_affine(patch, right, klt_, 1, state) != KltStatus::kTracked) return std::nullopt;
  if (std::abs(state.uv_px.x() - predicted_px.x()) > options_.max_prediction_error_px) return std::nullopt;
  return state;
}

bool StereoMatcher::plausible(const Eigen::Vector2f& left_px, const Eigen::Vector2f& right_px) const {
  const double disparity_px = left_px.x() - right_px.x() - rig_.disparity_at_infinity_px();
  return std::abs(left_px.y() - right_px.y()) <= options_.epipolar_gate_px &&
         disparity_px >= options_.min_disparity_px;
}

Eigen::Vector3d optimal_measurement(const Eigen::Vector2f& left_px, const Eigen::Vector2f& right_px) {
  return {left_px.x(), 0.5 * (left_px.y() + right_px.y()), right_px.x()};
}

Eigen::Matrix3d match_cofactor(const Eigen::Matrix2f& left_px2, const Eigen::Matrix2f& right_px2) {
  const Eigen::Matrix2d own = 0.5 / (kTypical_px * kTypical_px) * (left_px2 + right_px2).cast<double>();
  const double uu = own(0, 0) + kLeast * kLeast, vv = own(1, 1) + kLeast * kLeast, uv = own(0, 1);
  constexpr double kMean = 0.5 * (1 + kSameInBoth);  // of the mean of two rows
  Eigen::Matrix3d cofactor;
  cofactor << uu, kMean * uv, kSameInBoth * uu,  //
      kMean * uv, kMean * vv, kMean * uv,        //
      kSameInBoth * uu, kMean * uv, uu;
  return cofactor;
}

}  // namespace groundloop::slam
