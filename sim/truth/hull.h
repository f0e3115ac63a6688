#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "sim/truth/solid.h"

namespace groundloop::sim {

/// Corners of the convex hull, counter-clockwise, without repeats. One or two points for degenerate input.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// Distance [m] of a point to a convex polygon (counter-clockwise, or fewer than three points); 0 inside.
double distance_to_hull(const Eigen::Vector2d& point, const std::vector<Eigen::Vector2d>& hull);

using Edges = std::array<std::pair<int, int>, 12>;
std::array<Eigen::Vector3d, 8> box_corners(const OrientedBox& box);
const Edges& box_edges();

/// Points in the x-y plane whose hull is the projection of the part of a convex body between two heights z.
std::vector<Eigen::Vector2d> project_slab(const std::array<Eigen::Vector3d, 8>& corners, const Edges& edges,
                                          double z_min, double z_max);

}  // namespace groundloop::sim
