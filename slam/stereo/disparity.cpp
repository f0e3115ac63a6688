#include "slam/stereo/disparity.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "slam/stereo/on_time_view.h"

namespace groundloop::slam {

namespace {

constexpr int kFixedPoint = 16;  // of OpenCV's disparity maps
constexpr int16_t kUnknown = -kFixedPoint;

/// A homography of full-resolution pixels as one of half-resolution pixels.
Eigen::Matrix3d halved(const Eigen::Matrix3d& full) {
  Eigen::Matrix3d full_of_half;
  full_of_half << 2, 0, 0.5, 0, 2, 0.5, 0, 0, 1;
  return full_of_half.inverse() * full * full_of_half;
}

/// The half-resolution right image as it would have been in time.
void draw_in_time(const cv::Mat& half_late, const OnTimeView& view, cv::Mat& half_view) {
  const Eigen::Matrix3d late_of_view = halved(view.late_of_view());
  cv::Matx33d by_cv;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(by_cv.val) = late_of_view;
  cv::warpPerspective(half_late, half_view, by_cv, half_late.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                      cv::BORDER_REPLICATE);
}

}  // namespace

DenseDisparity::DenseDisparity(const DisparityOptions& options)
    : matcher_(cv::StereoBM::create(options.max_disparity_px / 2, options.window_px)) {
  matcher_->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  matcher_->setUniquenessRatio(options.uniqueness_percent);
  matcher_->setTextureThreshold(options.texture_threshold);
  matcher_->setSpeckleWindowSize(0);
}

void DenseDisparity::compute(const cv::Mat& left, const cv::Mat& right, const OnTimeView* view) {
  cv::resize(left, half_left_, cv::Size(left.cols / 2, left.rows / 2), 0, 0, cv::INTER_AREA);
  cv::resize(right, half_right_, half_left_.size(), 0, 0, cv::INTER_AREA);
  if (view != nullptr) {
    draw_in_time(half_right_, *view, half_view_);
    cv::swap(half_right_, half_view_);
  }
  // The matcher leaves out the columns that it cannot search over the full width; a border gives it the room.
  const int border = matcher_->getNumDisparities();
  cv::copyMakeBorder(half_left_, wide_left_, 0, 0, border, 0, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(half_right_, wide_right_, 0, 0, border, 0, cv::BORDER_REPLICATE);
  matcher_->compute(wide_left_, wide_right_, wide_disparity_);
  wide_disparity_(cv::Rect(border, 0, half_left_.cols, half_left_.rows)).copyTo(disparity_);
  forget_matches_outside();
  if (view != nullptr) bring_in_time(*view);
}

void DenseDisparity::forget_matches_outside() {
  const int border = matcher_->getNumDisparities();
  for (int v = 0; v < disparity_.rows; ++v) {
    auto* values = disparity_.ptr<int16_t>(v);
    for (int u = 0; u < std::min(border, disparity_.cols); ++u) {
      if (values[u] > u * kFixedPoint) values[u] = kUnknown;
    }
  }
}

/// What the matches with the view of a late image are in a pair taken together; those with what the late
/// image does not show are forgotten.
void DenseDisparity::bring_in_time(const OnTimeView& view) {
  const Eigen::Matrix3d late_of_view = halved(view.late_of_view());
  const auto inside = [this](double u, double v) {
    return u >= 0 && v >= 0 && u <= disparity_.cols - 1 && v <= disparity_.rows - 1;
  };
  for (int v = 0; v < disparity_.rows; ++v) {
    auto* values = disparity_.ptr<int16_t>(v);
    for (int u = 0; u < disparity_.cols; ++u) {
      if (values[u] < 0) continue;
      const double u_view = u - values[u] / static_cast<double>(kFixedPoint);
      const Eigen::Vector3d late = late_of_view * Eigen::Vector3d(u_view, v, 1);
      const double in_time_px = view.disparity_px(2 * u + 0.5, 2 * u_view + 0.5);
      const bool known = inside(late.x() / late.z(), late.y() / late.z()) && in_time_px > 0;
      values[u] = known ? cv::saturate_cast<int16_t>(in_time_px / 2 * kFixedPoint) : kUnknown;
    }
  }
}

void sample_disparity(const cv::Mat& half_resolution, int step_px, int64_t turn,
                      std::vector<Eigen::Vector3f>& uvu_px) {
  constexpr int kReach = 2;
  constexpr int kSmooth =
      kFixedPoint;  // neighbours that differ by more than one half-resolution px: a jump of depth
  const int step = std::max(step_px / 2, 1);
  const auto u_first = kReach + static_cast<int>(turn % step);
  const auto v_first = kReach + static_cast<int>(turn / step % step);
  for (int v = v_first; v + kReach < half_resolution.rows; v += step) {
    const auto* here = half_resolution.ptr<int16_t>(v);
    const auto* above = half_resolution.ptr<int16_t>(v - kReach);
    const auto* below = half_resolution.ptr<int16_t>(v + kReach);
    for (int u = u_first; u + kReach < half_resolution.cols; u += step) {
      const int d = here[u];
      const auto smooth = [d](int neighbour) { return neighbour >= 0 && std::abs(neighbour - d) <= kSmooth; };
      if (d <= 0 || !smooth(here[u - kReach]) || !smooth(here[u + kReach]) || !smooth(above[u]) ||
          !smooth(below[u])) {
        continue;
      }
      const float u_px = 2.0F * static_cast<float>(u) + 0.5F, v_px = 2.0F * static_cast<float>(v) + 0.5F;
      uvu_px.emplace_back(u_px, v_px, u_px - 2.0F * static_cast<float>(d) / kFixedPoint);
    }
  }
}

std::optional<float> disparity_around(const cv::Mat& half_resolution, float u_px, float v_px) {
  constexpr int kReach = 3;
  constexpr size_t kLeast = 5;
  // Pixel (2i + 0.5) of the full image is pixel i of the half one.
  const int u = cvRound((u_px - 0.5F) / 2), v = cvRound((v_px - 0.5F) / 2);
  std::array<int16_t, (2 * kReach + 1) * (2 * kReach + 1)> known;
  size_t count = 0;
  for (int row = std::max(v - kReach, 0); row <= std::min(v + kReach, half_resolution.rows - 1); ++row) {
    const auto* values = half_resolution.ptr<int16_t>(row);
    for (int col = std::max(u - kReach, 0); col <= std::min(u + kReach, half_resolution.cols - 1); ++col) {
      if (values[col] >= 0) known[count++] = values[col];
    }
  }
  if (count < kLeast) return std::nullopt;
  std::nth_element(known.begin(), known.begin() + count / 2, known.begin() + count);
  return 2.0F * static_cast<float>(known[count / 2]) / kFixedPoint;
}

}  // namespace groundloop::slam
