#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// An occupied cell of the map that is to be placed, about that map's centre.
struct WeightedPoint {
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
  double weight = 1;
};

/// Where the points' centre may be in the global map, and how they may be turned.
struct SearchWindow {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  double half_rad = 0;
};

/// A place of the lattice that is searched.
struct SearchPeak {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
  double score = 0;  ///< sum over the points of weight times OccupiedField, each at its nearest cell
};

struct SearchResult {
  SearchPeak best;
  bool at_edge = false;              ///< the best lies on the border of the window
  std::optional<SearchPeak> second;  ///< best local maximum apart from the best, if at least half as high
};

/// How far from the best a second peak must be, in position or in heading.
struct Separation {
  double m = 0.2;
  double rad = 0.05;
};

/// Best places of a point set in a map, over a lattice of one cell and of the turn that moves the farthest
/// point by one cell. Correlative matching after Olson, ICRA 2009: block maxima of the map bound the scores
/// of a block of places from above, and blocks are opened in the order of their bounds until none that is
/// left can hold a better place; so the answer is that of the exhaustive search.
/// @param points  at least one
SearchResult search_peaks(const OccupancyMap& global, std::span<const WeightedPoint> points,
                          const SearchWindow& window, const Separation& separation);

}  // namespace groundloop::slam
