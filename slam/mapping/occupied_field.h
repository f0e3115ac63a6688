#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// How firmly a map holds a place for occupied, as a function with two continuous derivatives: the positive
/// part of its belief (2 value - 1), blurred by [1 2 1] / 4, on cubic B-splines. 0 where it is unknown or
/// free. The blur of sqrt(5/6) cells makes thin walls as wide as the search steps.
class OccupiedField {
 public:
  /// @param low_m, high_m  corners of the part of the map's plane that is needed; may reach beyond the map
  OccupiedField(const OccupancyMap& map, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);

  /// Value with derivatives by x and y [1/m, 1/m^2].
  struct Jet {
    double value = 0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  };
  double value(const Eigen::Vector2d& p_m) const;
  Jet jet(const Eigen::Vector2d& p_m) const;

  const GridGeometry& geometry() const { return geometry_; }
  /// Values at the centres of the cells of geometry().
  std::vector<float> at_centres() const;

 private:
  GridGeometry geometry_;
  std::vector<float> weight_;  ///< of the spline of every cell
};

}  // namespace groundloop::slam
