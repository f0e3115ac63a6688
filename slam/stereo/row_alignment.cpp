#include "slam/stereo/row_alignment.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace groundloop::slam {
namespace {

constexpr size_t kPairs = 3;         // one pair may be torn, three alike are not
constexpr size_t kFewest = 30;       // matches
constexpr double kMostAgree = 0.75;  // of all matches

}  // namespace

cv::Mat RowAlignment::aligned(const cv::Mat& right) {
  if (offset_px_ == 0) return right;
  const cv::Matx23d there(1, 0, 0, 0, 1, offset_px_);
  cv::warpAffine(right, aligned_, there, right.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  return aligned_;
}

std::optional<double> RowAlignment::observe(std::vector<float>& differences_px) {
  const double gate_px = options_.epipolar_gate_px;
  const auto part_near = [&](double middle_px) {
    const auto near = [&](float d) { return std::abs(d - middle_px) <= gate_px; };
    return static_cast<double>(std::count_if(differences_px.begin(), differences_px.end(), near)) /
           static_cast<double>(differences_px.size());
  };
  std::optional<double> off_px;
  if (differences_px.size() >= kFewest && part_near(0) < 0.5) {
    const auto middle = differences_px.begin() + static_cast<std::ptrdiff_t>(differences_px.size() / 2);
    std::nth_element(differences_px.begin(), middle, differences_px.end());
    if (part_near(*middle) >= kMostAgree) off_px = *middle;
  }
  if (!off_px || (!seen_px_.empty() && std::abs(*off_px - seen_px_.front()) > gate_px)) seen_px_.clear();
  if (!off_px) return std::nullopt;
  seen_px_.push_back(*off_px);
  if (seen_px_.size() < kPairs) return off_px;
  const double sum_px = std::accumulate(seen_px_.begin(), seen_px_.end(), 0.0);
  const double slipped_px = offset_px_ + sum_px / static_cast<double>(kPairs);
  seen_px_.clear();
  if (std::abs(slipped_px) <= options_.max_row_offset_px) offset_px_ = slipped_px;
  return off_px;
}

}  // namespace groundloop::slam
