#include "slam/stereo/disparity.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace groundloop::slam {

namespace {

constexpr int kFixedPoint = 16;  // of OpenCV's disparity maps

}  // namespace

DenseDisparity::DenseDisparity(const DisparityOptions& options)
    : matcher_(cv::StereoBM::create(options.max_disparity_px / 2, options.window_px)) {
  matcher_->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  matcher_->setUniquenessRatio(options.uniqueness_percent);
  matcher_->setTextureThreshold(options.texture_threshold);
  matcher_->setSpeckleWindowSize(0);
}

void DenseDisparity::compute(const cv::Mat& left, const cv::Mat& right) {
  cv::resize(left, half_left_, cv::Size(left.cols / 2, left.rows / 2), 0, 0, cv::INTER_AREA);
  cv::resize(right, half_right_, half_left_.size(), 0, 0, cv::INTER_AREA);
  // The matcher leaves out the columns that it cannot search over the full width; a border gives it the room.
  const int border = matcher_->getNumDisparities();
  cv::copyMakeBorder(half_left_, wide_left_, 0, 0, border, 0, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(half_right_, wide_right_, 0, 0, border, 0, cv::BORDER_REPLICATE);
  matcher_->compute(wide_left_, wide_right_, wide_disparity_);
  wide_disparity_(cv::Rect(border, 0, half_left_.cols, half_left_.rows)).copyTo(disparity_);
  forget_matches_outside();
}

void DenseDisparity::forget_matches_outside() {
  const int border = matcher_->getNumDisparities();
  for (int v = 0; v < disparity_.rows; ++v) {
    auto* values = disparity_.ptr<int16_t>(v);
    for (int u = 0; u < std::min(border, disparity_.cols); ++u) {
      if (values[u] > u * kFixedPoint) values[u] = -kFixedPoint;
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
