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
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d origin_m(grid.x_min_m, grid.y_min_m);
  const Eigen::Vector2d from = (from_m - origin_m) / grid.cell_m, to = (to_m - origin_m) / grid.cell_m;
  struct Axis {
    int cell, step, steps;
    double next, spacing;  // parameter of the next border, and between borders
  };
  const auto axis = [](double start, double end) {
    const double along = end - start;
    const int cell = static_cast<int>(std::floor(start));
    const int steps = std::abs(static_cast<int>(std::floor(end)) - cell);
    if (along == 0) return Axis{cell, 1, steps, kNever, kNever};
    const double spacing = std::abs(1 / along);
    return along < 0 ? Axis{cell, -1, steps, (start - cell) * spacing, spacing}
                     : Axis{cell, 1, steps, (cell + 1 - start) * spacing, spacing};
  };
  Axis x = axis(from.x(), to.x()), y = axis(from.y(), to.y());
  for (int steps = x.steps + y.steps;; --steps) {
    if (grid.contains(x.cell, y.cell)) visit(x.cell, y.cell);
    if (steps <= 0) return;
    // Which border comes next is as good as chance: selected, since a branch would be guessed wrongly half
    // the time.
    const bool across_x = x.next < y.next;
    x.cell += across_x ? x.step : 0;
    y.cell += across_x ? 0 : y.step;
    x.next += across_x ? x.spacing : 0.0;
    y.next += across_x ? 0.0 : y.spacing;
  }
}

}  // namespace groundloop::sim
