#include "slam/loop/descriptors.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "slam/features/multiversion.h"
#include "slam/stereo/disparity.h"

namespace groundloop::slam {
namespace {

constexpr int kHalved = 2;  // the finest level: what is seen from elsewhere has lost its details
constexpr int kLevels = 4;
constexpr float kScaleFactor = 1.3F;  // between levels; together they cover a factor of 2.2
constexpr int kEdge_px = 12;
constexpr int kPatch_px = 31;
constexpr int kFastThreshold_grey = 10;
constexpr int kCells = 8;  // a side; a corner-rich part of the image must not take all the places

}  // namespace

Describer::Describer(int keypoints)
    : wanted_(keypoints),
      orb_(cv::ORB::create(3 * keypoints, kScaleFactor, kLevels, kEdge_px, 0, 2, cv::ORB::HARRIS_SCORE,
                           kPatch_px, kFastThreshold_grey)) {}

void Describer::describe(const cv::Mat& grey, const cv::Mat& half_disparity, std::vector<Keypoint>& found) {
  found.clear();
  corners_.clear();
  cv::pyrDown(grey, half_);
  orb_->detect(half_, corners_);
  std::sort(corners_.begin(), corners_.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    if (a.response != b.response) return a.response > b.response;
    if (a.pt.y != b.pt.y) return a.pt.y < b.pt.y;
    return a.pt.x != b.pt.x ? a.pt.x < b.pt.x : a.octave < b.octave;
  });

  // the strongest of each cell, with known depth; class_id, which ORB leaves alone, carries its place
  std::vector<float> disparity_px;
  std::array<int, kCells * kCells> taken{};
  const int cell_limit = 3 * wanted_ / (kCells * kCells) + 1;
  size_t kept = 0;
  for (const cv::KeyPoint& corner : corners_) {
    const int column = std::min(static_cast<int>(corner.pt.x) * kCells / half_.cols, kCells - 1);
    const int row = std::min(static_cast<int>(corner.pt.y) * kCells / half_.rows, kCells - 1);
    if (taken[row * kCells + column] >= cell_limit) continue;
    const std::optional<float> d =
        disparity_around(half_disparity, kHalved * corner.pt.x, kHalved * corner.pt.y);
    if (!d || *d <= 0) continue;
    ++taken[row * kCells + column];
    corners_[kept] = corner;
    corners_[kept].class_id = static_cast<int>(kept);
    disparity_px.push_back(*d);
    if (++kept == static_cast<size_t>(wanted_)) break;
  }
  corners_.resize(kept);
  if (corners_.empty()) return;

  orb_->compute(half_, corners_, bits_);
  for (size_t i = 0; i < corners_.size(); ++i) {
    Keypoint keypoint;
    const cv::Point2f uv = kHalved * corners_[i].pt;
    keypoint.uvu_px = {uv.x, uv.y, uv.x - disparity_px[static_cast<size_t>(corners_[i].class_id)]};
    std::memcpy(keypoint.descriptor.data(), bits_.ptr(static_cast<int>(i)), sizeof(Descriptor));
    found.push_back(keypoint);
  }
}

int distance(const Descriptor& a, const Descriptor& b) {
  int result = 0;
  distances(a, &b, 1, &result);
  return result;
}

GROUNDLOOP_MULTIVERSION
void distances(const Descriptor& a, const Descriptor* others, int count, int* result) {
  for (int i = 0; i < count; ++i) {
    const Descriptor& b = others[i];
    result[i] = __builtin_popcountll(a[0] ^ b[0]) + __builtin_popcountll(a[1] ^ b[1]) +
                __builtin_popcountll(a[2] ^ b[2]) + __builtin_popcountll(a[3] ^ b[3]);
  }
}

void match_descriptors(const std::vector<Keypoint>& a, const std::vector<Keypoint>& b, int max_distance,
                       double ratio, std::vector<DescriptorMatch>& matches) {
  constexpr int kFar = 257;
  matches.clear();
  std::vector<Descriptor> others;
  others.reserve(b.size());
  for (const Keypoint& keypoint : b) others.push_back(keypoint.descriptor);
  std::vector<int> row(b.size());
  std::vector<int> column_best(b.size(), kFar), column_a(b.size(), -1);
  std::vector<DescriptorMatch> forward;
  for (size_t i = 0; i < a.size(); ++i) {
    distances(a[i].descriptor, others.data(), static_cast<int>(others.size()), row.data());
    int best = kFar, second = kFar, best_j = -1;
    for (size_t j = 0; j < row.size(); ++j) {
      if (row[j] < best) {
        second = best;
        best = row[j];
        best_j = static_cast<int>(j);
      } else if (row[j] < second) {
        second = row[j];
      }
      if (row[j] < column_best[j]) {
        column_best[j] = row[j];
        column_a[j] = static_cast<int>(i);
      }
    }
    if (best <= max_distance && best < ratio * second) forward.push_back({static_cast<int>(i), best_j});
  }
  for (const DescriptorMatch& match : forward) {
    if (column_a[static_cast<size_t>(match.b)] == match.a) matches.push_back(match);
  }
}

}  // namespace groundloop::slam
