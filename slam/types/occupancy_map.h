#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

namespace groundloop::slam {

/// An axis-aligned 2-D grid on the horizontal plane of some frame. Cell (col, row) covers
/// [x_min + col h, x_min + (col+1) h) x [y_min + row h, y_min + (row+1) h).
struct GridGeometry {
  double cell_m = 0.05;
  double x_min_m = 0;
  double y_min_m = 0;
  int cols = 0;
  int rows = 0;

  size_t cells() const { return static_cast<size_t>(cols) * rows; }
  size_t index(int col, int row) const { return static_cast<size_t>(row) * cols + col; }
  bool contains(int col, int row) const { return col >= 0 && row >= 0 && col < cols && row < rows; }
  int col_of(double x_m) const { return static_cast<int>(std::floor((x_m - x_min_m) / cell_m)); }
  int row_of(double y_m) const { return static_cast<int>(std::floor((y_m - y_min_m) / cell_m)); }
  Eigen::Vector2d centre_m(int col, int row) const {
    return {x_min_m + (col + 0.5) * cell_m, y_min_m + (row + 0.5) * cell_m};
  }
};

/// Occupancy of a horizontal band as one value a cell: 0 free, 0.5 unknown, 1 occupied. Row 0 is the lowest
/// y.
struct OccupancyMap {
  GridGeometry geometry;
  std::vector<float> value;  ///< geometry.cells() values in [0, 1]

  static constexpr float kUnknown = 0.5F;
  static constexpr float kOccupiedAbove = 0.65F;  ///< as ROS map_server's occupied_thresh
  static constexpr float kFreeBelow = 0.35F;      ///< as ROS map_server's free_thresh

  float at(int col, int row) const { return value[geometry.index(col, row)]; }
  /// Value of the cell that holds the point; unknown outside the grid.
  float at_point(double x_m, double y_m) const {
    const int col = geometry.col_of(x_m), row = geometry.row_of(y_m);
    return geometry.contains(col, row) ? at(col, row) : kUnknown;
  }
};

}  // namespace groundloop::slam
