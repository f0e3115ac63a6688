#include "slam/features/detector.h"

#include <algorithm>
#include <cstring>
#include <opencv2/core.hpp>

#include "slam/features/multiversion.h"

namespace groundloop::slam {
namespace {

/// Marks the local maxima of the 3 x 3 neighbourhood; ties go to the first in reading order.
/// @param n  pixels; one more is read on both sides
GROUNDLOOP_MULTIVERSION
void mark_maxima(const float* __restrict above, const float* __restrict here, const float* __restrict below,
                 float least, uint8_t* __restrict marks, int n) {
  for (int u = 0; u < n; ++u) {
    const float r = here[u];
    const int before = (r > here[u - 1]) & (r > above[u - 1]) & (r > above[u]) & (r > above[u + 1]);
    const int after = (r >= here[u + 1]) & (r >= below[u - 1]) & (r >= below[u]) & (r >= below[u + 1]);
    marks[u] = static_cast<uint8_t>((r >= least) & before & after);
  }
}

/// Spatial hash that answers whether any taken point lies within a distance.
class Neighbourhood {
 public:
  Neighbourhood(cv::Size image, double distance_px)
      : distance2_(static_cast<float>(distance_px * distance_px)),
        cell_(static_cast<float>(distance_px)),
        cols_(static_cast<int>(image.width / cell_) + 1),
        rows_(static_cast<int>(image.height / cell_) + 1),
        cells_(static_cast<size_t>(cols_) * rows_) {}

  bool free(const Eigen::Vector2f& p) const {
    const int col = column(p), row = line(p);
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
      for (int c = std::max(col - 1, 0); c <= std::min(col + 1, cols_ - 1); ++c) {
        for (const Eigen::Vector2f& q : cells_[static_cast<size_t>(r) * cols_ + c]) {
          if ((p - q).squaredNorm() < distance2_) return false;
        }
      }
    }
    return true;
  }

  void take(const Eigen::Vector2f& p) {
    cells_[static_cast<size_t>(line(p)) * cols_ + column(p)].push_back(p);
  }

 private:
  int column(const Eigen::Vector2f& p) const {
    return std::clamp(static_cast<int>(p.x() / cell_), 0, cols_ - 1);
  }
  int line(const Eigen::Vector2f& p) const {
    return std::clamp(static_cast<int>(p.y() / cell_), 0, rows_ - 1);
  }

  float distance2_, cell_;
  int cols_, rows_;
  std::vector<std::vector<Eigen::Vector2f>> cells_;
};

}  // namespace

const std::vector<Eigen::Vector2f>& Detector::detect(const cv::Mat& grey,
                                                     const std::vector<Eigen::Vector2f>& occupied, int wanted,
                                                     int border_px) {
  corners_.clear();
  if (wanted <= 0 || grey.cols <= 2 * border_px + 2 || grey.rows <= 2 * border_px + 2) return corners_;

  const cv::Mat& response = response_.compute(grey);
  const cv::Rect inside(border_px, border_px, grey.cols - 2 * border_px, grey.rows - 2 * border_px);
  double strongest = 0;
  cv::minMaxLoc(response(inside), nullptr, &strongest);
  const auto least = static_cast<float>(std::max(options_.quality * strongest, options_.min_response));

  candidates_.clear();
  marks_.resize(inside.width);
  for (int v = inside.y; v < inside.y + inside.height; ++v) {
    const float* here = response.ptr<float>(v) + inside.x;
    mark_maxima(response.ptr<float>(v - 1) + inside.x, here, response.ptr<float>(v + 1) + inside.x, least,
                marks_.data(), inside.width);
    const uint8_t* const end = marks_.data() + inside.width;
    for (const uint8_t* mark = marks_.data();
         (mark = static_cast<const uint8_t*>(std::memchr(mark, 1, end - mark))) != nullptr; ++mark) {
      const auto u = static_cast<int>(mark - marks_.data());
      candidates_.push_back({here[u], inside.x + u, v});
    }
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.v != b.v ? a.v < b.v : a.u < b.u;
  });

  Neighbourhood neighbourhood(grey.size(), options_.min_distance_px);
  for (const Eigen::Vector2f& p : occupied) neighbourhood.take(p);
  for (const Candidate& candidate : candidates_) {
    const Eigen::Vector2f p(static_cast<float>(candidate.u), static_cast<float>(candidate.v));
    if (!neighbourhood.free(p)) continue;
    neighbourhood.take(p);
    corners_.push_back(p);
    if (static_cast<int>(corners_.size()) == wanted) break;
  }
  return corners_;
}

}  // namespace groundloop::slam
