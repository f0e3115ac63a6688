#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// A rectangle of a floor plan, axis-aligned [m].
struct PlanRectangle {
  Eigen::Vector2d low, high;
};

/// The map of a floor plan in a frame of its own: occupied by the share of the cell that the rectangles
/// cover, free elsewhere.
inline OccupancyMap drawn_map(const std::vector<PlanRectangle>& plan, const Eigen::Isometry2d& T_map_plan,
                              const GridGeometry& geometry) {
  constexpr int kSamples = 8;  // along the side of a cell
  const Eigen::Isometry2d T_plan_map = T_map_plan.inverse();
  OccupancyMap map{geometry, std::vector<float>(geometry.cells(), 0)};
  for (size_t cell = 0; cell < geometry.cells(); ++cell) {
    const auto cols = static_cast<size_t>(geometry.cols);
    const Eigen::Vector2d corner_m(geometry.x_min_m + static_cast<double>(cell % cols) * geometry.cell_m,
                                   geometry.y_min_m + static_cast<double>(cell / cols) * geometry.cell_m);
    int inside = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const Eigen::Vector2d sample(i % kSamples + 0.5, i / kSamples + 0.5);
      const Eigen::Vector2d p = T_plan_map * (corner_m + sample * geometry.cell_m / kSamples);
      for (const PlanRectangle& r : plan) {
        if ((p.array() >= r.low.array()).all() && (p.array() < r.high.array()).all()) {
          ++inside;
          break;
        }
      }
    }
    map.value[cell] = static_cast<float>(inside) / (kSamples * kSamples);
  }
  return map;
}

inline Eigen::Isometry2d planar(double x_m, double y_m, double yaw_rad) {
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translate(Eigen::Vector2d(x_m, y_m)).rotate(yaw_rad);
  return T;
}

}  // namespace groundloop::slam
