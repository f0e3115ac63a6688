#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/truth/truth_world.h"

namespace groundloop::sim {

/// Where a disc can stand: exact occupancy between the floor and table height, and the distance to it. What lies
/// outside of walls does not belong to it, nor what cannot be reached.
class FreeSpace {
 public:
  /// @param need_m  distance that the disc's centre keeps from everything
  FreeSpace(const TruthWorld& world, double need_m);

  double need_m() const { return need_m_; }
  const slam::GridGeometry& grid() const { return grid_; }
  /// Distance from the nearest thing, never too large; 0 outside of the region.
  double clearance_m(double x_m, double y_m) const;
  bool holds(double x_m, double y_m) const { return clearance_m(x_m, y_m) >= need_m_; }
  /// True when the straight way from a to b is free.
  bool holds_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Area in which the centre may be [m^2].
  double area_m2() const { return area_m2_; }

 private:
  double need_m_;
  slam::GridGeometry grid_;
  cv::Mat clearance_m_;  ///< CV_32F, row 0 at the lowest y
  double area_m2_ = 0;
};

}  // namespace groundloop::sim
