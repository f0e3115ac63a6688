#include "slam/stereo/matcher.h"

#include <cmath>

namespace groundloop::slam {

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

}  // namespace groundloop::slam
