#include "sim/generate/free_space.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace groundloop::sim {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kStep_m = 0.05;
/// Lower than this nothing is driven under: a robot below a desk sees little.
constexpr double kFloor_m = 0.02, kTable_m = 1.2;

/// The largest connected region, that of a room in preference to the strip around its walls.
int main_region(const cv::Mat& labels, const cv::Mat& stats, int regions) {
  int best = 0, best_area = -1;
  for (int i = 1; i < regions; ++i) {
    const int left = stats.at<int>(i, cv::CC_STAT_LEFT), top = stats.at<int>(i, cv::CC_STAT_TOP);
    const bool at_border = left == 0 || top == 0 || left + stats.at<int>(i, cv::CC_STAT_WIDTH) == labels.cols ||
                           top + stats.at<int>(i, cv::CC_STAT_HEIGHT) == labels.rows;
    const int area = at_border ? 0 : stats.at<int>(i, cv::CC_STAT_AREA);
    if (area > best_area) best = i, best_area = area;
  }
  return best;
}

}  // namespace

FreeSpace::FreeSpace(const TruthWorld& world, double need_m) : need_m_(need_m), grid_(world.bounds(kCell_m)) {
  const slam::OccupancyMap map = world.occupancy(grid_, kFloor_m, kTable_m);
  cv::Mat empty(grid_.rows, grid_.cols, CV_8U);
  for (int row = 0; row < grid_.rows; ++row) {
    for (int col = 0; col < grid_.cols; ++col) {
      empty.at<uint8_t>(row, col) = map.value[grid_.index(col, row)] > 0 ? 0 : 255;
    }
  }
  cv::distanceTransform(empty, clearance_m_, cv::DIST_L2, cv::DIST_MASK_PRECISE, CV_32F);
  // From centre to centre of cells: both may be off by half a diagonal.
  clearance_m_ = clearance_m_ * kCell_m - std::sqrt(2.0) * kCell_m;

  cv::Mat labels, stats, centroids;
  const cv::Mat standing = clearance_m_ >= need_m_;
  const int regions = cv::connectedComponentsWithStats(standing, labels, stats, centroids, 4, CV_32S);
  const int region = regions > 1 ? main_region(labels, stats, regions) : -1;
  clearance_m_.setTo(0, labels != region);
  area_m2_ = cv::countNonZero(labels == region) * kCell_m * kCell_m;
}

double FreeSpace::clearance_m(double x_m, double y_m) const {
  const int col = grid_.col_of(x_m), row = grid_.row_of(y_m);
  return grid_.contains(col, row) ? clearance_m_.at<float>(row, col) : 0.0;
}

bool FreeSpace::holds_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kStep_m)));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = a + (b - a) * i / steps;
    if (!holds(p.x(), p.y())) return false;
  }
  return true;
}

}  // namespace groundloop::sim
