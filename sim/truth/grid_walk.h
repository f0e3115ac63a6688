#pragma once

#include <Eigen/Core>

#include <cmath>
#include <limits>

#include "slam/types/occupancy_map.h"

namespace groundloop::sim {

/// Calls visit(col, row) for every cell of the grid that the segment passes through, in order (Amanatides &
/// Woo, Eurographics 1987). Cells outside the grid are skipped.
template <class Visit>
void walk_cells(const slam::GridGeometry& grid, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                Visit&& visit) {
  const Eigen::Vector2d origin_m(grid.x_min_m, grid.y_min_m);
  const Eigen::Vector2d from = (from_m - origin_m) / grid.cell_m, to = (to_m - origin_m) / grid.cell_m;
  const Eigen::Vector2d along = to - from;
  int cell[2], step[2];
  double next[2], spacing[2];  // parameter of the next border and between borders, for each axis
  int steps = 0;
  for (int axis = 0; axis < 2; ++axis) {
    cell[axis] = static_cast<int>(std::floor(from[axis]));
    steps += std::abs(static_cast<int>(std::floor(to[axis])) - cell[axis]);
    step[axis] = along[axis] < 0 ? -1 : 1;
    spacing[axis] = along[axis] != 0 ? std::abs(1 / along[axis]) : std::numeric_limits<double>::infinity();
    const double border = step[axis] > 0 ? cell[axis] + 1 - from[axis] : from[axis] - cell[axis];
    next[axis] = along[axis] != 0 ? border * spacing[axis] : std::numeric_limits<double>::infinity();
  }
  for (;; --steps) {
    if (grid.contains(cell[0], cell[1])) visit(cell[0], cell[1]);
    if (steps <= 0) return;
    const int axis = next[0] < next[1] ? 0 : 1;
    cell[axis] += step[axis];
    next[axis] += spacing[axis];
  }
}

}  // namespace groundloop::sim
