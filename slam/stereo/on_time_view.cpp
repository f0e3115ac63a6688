#include "slam/stereo/on_time_view.h"

#include <Eigen/LU>
#include <cmath>

namespace groundloop::slam {
namespace {

/// Grey value between pixels; negative at the border and beyond.
float grey_at(const cv::Mat& image, float u_px, float v_px) {
  const float u_whole = std::floor(u_px), v_whole = std::floor(v_px);
  if (!(u_whole >= 0 && v_whole >= 0 && u_whole + 1 < image.cols && v_whole + 1 < image.rows)) return -1;
  const float right = u_px - u_whole, down = v_px - v_whole;
  const auto* upper = image.ptr<uint8_t>(static_cast<int>(v_whole)) + static_cast<int>(u_whole);
  const auto* lower = upper + image.step;
  const float above = upper[0] + right * (upper[1] - upper[0]),
              below = lower[0] + right * (lower[1] - lower[0]);
  return above + down * (below - above);
}

}  // namespace

OnTimeView::OnTimeView(const StereoRig& rig, const RightLag& lag, double depth_m)
    : fx_px_(rig.fx_px),
      cx_px_(rig.cx_px),
      at_infinity_px_(rig.disparity_at_infinity_px()),
      depth_factor_px_m_(rig.fx_px * rig.baseline_m) {
  const Eigen::Vector3d right_in_left(rig.baseline_m, 0, 0);
  const Pose& T_late_left = lag.T_late_left();
  const Eigen::Vector3d centre = T_late_left.inverse() * right_in_left;
  centre_x_m_ = centre.x();
  centre_z_m_ = centre.z();

  // What the right camera in time sees along r = (x, y, 1) is on the plane at depth r + right_in_left; the
  // late one sees it along R (depth r + right_in_left - centre).
  const Eigen::Vector3d way_per_depth = (right_in_left - centre) / depth_m;
  Eigen::Matrix3d by_ray = Eigen::Matrix3d::Identity(), K;
  by_ray.col(2) += way_per_depth;
  K << rig.fx_px, 0, rig.cx_right_px, 0, rig.fy_px, rig.cy_px, 0, 0, 1;
  late_of_view_ = K * T_late_left.linear() * by_ray * K.inverse();

  ray_per_px_ = 1 / (rig.fx_px * (1 + way_per_depth.z()));
  u_view_zero_px_ = rig.cx_right_px - rig.fx_px * way_per_depth.x();
}

bool OnTimeView::draw(const cv::Mat& late, const Eigen::Vector2i& first, cv::Mat& view) const {
  for (int y = 0; y < view.rows; ++y) {
    auto* row = view.ptr<uint8_t>(y);
    Eigen::Vector3d at = late_of_view_ * Eigen::Vector3d(first.x(), first.y() + y, 1);
    for (int x = 0; x < view.cols; ++x, at += late_of_view_.col(0)) {
      const float grey =
          grey_at(late, static_cast<float>(at.x() / at.z()), static_cast<float>(at.y() / at.z()));
      if (grey < 0) return false;
      row[x] = static_cast<uint8_t>(grey + 0.5F);
    }
  }
  return true;
}

}  // namespace groundloop::slam
