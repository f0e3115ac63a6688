#include "slam/stereo/dense_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/features/multiversion.h"
#include "slam/stereo/on_time_view.h"

namespace groundloop::slam {
namespace {

// Even numbers: a point of the half-resolution map lies in the middle between four pixels, and so does the
// window's middle; sixteen columns are whole vectors on every machine.
constexpr int kCols = 16, kRows = 12;
constexpr float kPixels = kCols * kRows;
constexpr int kIterations = 5;
constexpr float kConverged_px = 0.02F;
constexpr float kLeastNoise_grey = 1;  // rounding of grey values
constexpr float kModel_px = 0.1F;      // interpolation, curvature and slant: what is left with any texture

using Lanes = float[kCols];

/// The left image's window: grey values, horizontal gradient and its moments.
struct Window {
  alignas(64) float grey[kRows][kCols];
  alignas(64) float slope[kRows][kCols];
  float slopes = 0;           ///< sum of g
  float energy = 0;           ///< sum of g^2
  float column = 0, row = 0;  ///< centroid of g^2, from the window's first pixel
};

/// Left minus right at some disparity.
struct Difference {
  float sum = 0, squares = 0, times_slope = 0;
};

float sum_of(const Lanes& lanes) {
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

/// @param first  first pixel of the window; the pixels left and right of the window are read too
GROUNDLOOP_MULTIVERSION
void take(const uint8_t* first, size_t stride, Window& window) {
  alignas(64) Lanes slopes{}, energy{}, rows{};
  for (int y = 0; y < kRows; ++y, first += stride) {
    for (int x = 0; x < kCols; ++x) {
      const float g = 0.5F * (static_cast<float>(first[x + 1]) - static_cast<float>(first[x - 1]));
      window.grey[y][x] = first[x];
      window.slope[y][x] = g;
      slopes[x] += g;
      energy[x] += g * g;
      rows[x] += static_cast<float>(y) * g * g;
    }
  }
  window.slopes = sum_of(slopes);
  window.energy = sum_of(energy);
  window.row = sum_of(rows) / window.energy;
  for (int x = 0; x < kCols; ++x) energy[x] *= static_cast<float>(x);
  window.column = sum_of(energy) / window.energy;
}

/// @param first     of the right image's window, rounded to the left; kCols + 1 columns are read
/// @param fraction  that the window lies farther right, in [0, 1)
GROUNDLOOP_MULTIVERSION
Difference compare(const Window& window, const uint8_t* first, size_t stride, float fraction) {
  alignas(64) Lanes sum{}, squares{}, times_slope{};
  for (int y = 0; y < kRows; ++y, first += stride) {
    for (int x = 0; x < kCols; ++x) {
      const float a = first[x], b = first[x + 1];
      const float e = window.grey[y][x] - (a + fraction * (b - a));
      sum[x] += e;
      squares[x] += e * e;
      times_slope[x] += e * window.slope[y][x];
    }
  }
  return {sum_of(sum), sum_of(squares), sum_of(times_slope)};
}

/// Right image, or as much of it as is there.
struct RightPart {
  const cv::Mat& grey;
  Eigen::Vector2i first;  ///< its first pixel
};

struct Refined {
  DensePoint point;
  float misfit_grey = 0;
};

/// First pixel of the left image's window about a rough point.
Eigen::Vector2i window_at(const Eigen::Vector3f& uvu_px) {
  return {static_cast<int>(uvu_px.x()) - kCols / 2 + 1, static_cast<int>(uvu_px.y()) - kRows / 2 + 1};
}

std::optional<Refined> refine(const cv::Mat& left, const RightPart& right,
                              const Eigen::Vector3f& rough_uvu_px, const DenseMapOptions& options) {
  const int u = window_at(rough_uvu_px).x(), v = window_at(rough_uvu_px).y();
  if (u < 1 || v < 0 || u + kCols >= left.cols || v + kRows > left.rows) return std::nullopt;
  const auto max_sigma_px = static_cast<float>(options.max_sigma_px);
  const auto max_correction_px = static_cast<float>(options.max_correction_px);
  Window window;
  take(left.ptr<uint8_t>(v) + u, left.step, window);
  const float texture = window.energy - window.slopes * window.slopes / kPixels;
  if (!(max_sigma_px * max_sigma_px * texture > kLeastNoise_grey * kLeastNoise_grey)) return std::nullopt;

  const float rough_px = rough_uvu_px.x() - rough_uvu_px.z();
  float disparity_px = rough_px;
  const uint8_t* row = right.grey.ptr<uint8_t>(v - right.first.y());
  for (int i = 0; i < kIterations; ++i) {
    const float u_right = static_cast<float>(u) - disparity_px;
    const float whole = std::floor(u_right);
    const int column = static_cast<int>(whole) - right.first.x();
    if (column < 0 || column + kCols >= right.grey.cols) return std::nullopt;
    const Difference e = compare(window, row + column, right.grey.step, u_right - whole);
    const float step_px = (e.times_slope - window.slopes * e.sum / kPixels) / texture;
    disparity_px -= std::clamp(step_px, -1.0F, 1.0F);
    if (std::abs(disparity_px - rough_px) > max_correction_px) return std::nullopt;
    if (std::abs(step_px) > kConverged_px) continue;

    // Noise of variance s^2 a pixel and image gives the difference 2 s^2, and a gradient s^2 / 2.
    const float variance = std::max(0.0F, (e.squares - e.sum * e.sum / kPixels) / kPixels);
    const float true_texture = texture - kPixels * variance / 4;
    if (!(true_texture > 0)) return std::nullopt;
    const float misfit_grey = std::sqrt(variance);
    const float sigma_px = std::max(misfit_grey, kLeastNoise_grey) / std::sqrt(true_texture);
    if (sigma_px > max_sigma_px) return std::nullopt;
    const float u_left = static_cast<float>(u) + window.column;
    return Refined{{{u_left, static_cast<float>(v) + window.row, u_left - disparity_px},
                    std::hypot(sigma_px, kModel_px)},
                   misfit_grey};
  }
  return std::nullopt;
}

/// The same with a late right image.
/// @param view    at the point's rough depth
/// @param around  for its surroundings there
std::optional<Refined> refine_late(const cv::Mat& left, const cv::Mat& late, const OnTimeView& view,
                                   const Eigen::Vector3f& rough_uvu_px, const DenseMapOptions& options,
                                   cv::Mat& around) {
  const int room = (around.cols - kCols) / 2;
  const float rough_px = rough_uvu_px.x() - rough_uvu_px.z();
  const Eigen::Vector2i window = window_at(rough_uvu_px);
  const Eigen::Vector2i first(window.x() - static_cast<int>(std::ceil(rough_px)) - room, window.y());
  if (!view.draw(late, first, around)) return std::nullopt;
  std::optional<Refined> refined = refine(left, {around, first}, rough_uvu_px, options);
  if (refined) {
    Eigen::Vector3f& uvu_px = refined->point.uvu_px;
    uvu_px.z() = uvu_px.x() - static_cast<float>(view.disparity_px(uvu_px.x(), uvu_px.z()));
  }
  return refined;
}

}  // namespace

DensePoints::DensePoints(const StereoRig& rig, const DenseMapOptions& options)
    : rig_(rig), options_(options) {
  const int room = static_cast<int>(std::ceil(options.max_correction_px)) + 1;
  around_.create(kRows, kCols + 2 * room + 1, CV_8UC1);
}

const std::vector<DensePoint>& DensePoints::measure(const cv::Mat& left, const cv::Mat& right,
                                                    const cv::Mat& rough, const RightLag& lag) {
  rough_uvu_px_.clear(), points_.clear(), misfit_grey_.clear();
  if (options_.step_px <= 0) return points_;
  sample_disparity(rough, options_.step_px, turn_++, rough_uvu_px_);
  for (const Eigen::Vector3f& uvu_px : rough_uvu_px_) {
    std::optional<Refined> refined;
    if (lag.none()) {
      refined = refine(left, {right, {0, 0}}, uvu_px, options_);
    } else if (const auto p_left = rig_.triangulate(uvu_px.cast<double>())) {
      refined = refine_late(left, right, OnTimeView(rig_, lag, p_left->z()), uvu_px, options_, around_);
    }
    if (!refined) continue;
    points_.push_back(refined->point);
    misfit_grey_.push_back(refined->misfit_grey);
  }
  if (!points_.empty()) forget_misfits();
  return points_;
}

/// Two surfaces in one window, or a wrong match, disagree by more than the noise of this pair.
void DensePoints::forget_misfits() {
  sorted_misfit_grey_ = misfit_grey_;
  const auto middle = sorted_misfit_grey_.begin() + static_cast<std::ptrdiff_t>(points_.size() / 2);
  std::nth_element(sorted_misfit_grey_.begin(), middle, sorted_misfit_grey_.end());
  const float limit = static_cast<float>(options_.max_misfit) * std::max(*middle, kLeastNoise_grey);
  size_t kept = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    if (misfit_grey_[i] <= limit) points_[kept++] = points_[i];
  }
  points_.resize(kept);
}

}  // namespace groundloop::slam
