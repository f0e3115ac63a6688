#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/mapping/local_map.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Solid, axis-aligned [m].
struct Box {
  Eigen::Vector3d low, high;
};

/// A furnished room made of boxes, whose occupancy is known exactly, and a head that measures points in it:
/// the mapper's truth, without a renderer.
class RoomWorld {
 public:
  /// 14 m x 9 m x 3 m, walls off the lattice of cells: desks on legs, cupboards, crates, a shelf.
  static RoomWorld laboratory();

  /// Distance along a unit direction to the first surface; none when the ray leaves the room.
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// 1 where a solid reaches into the cell between the heights, else 0.
  OccupancyMap occupancy(const GridGeometry& geometry, double z_min_m, double z_max_m) const;

  std::vector<Box> boxes;
};

/// The STH-MDCS with 6 mm lenses.
StereoRig laboratory_rig();

/// Poses of the left camera on a lap through the laboratory, 0.35 m above the floor.
std::vector<Pose> laboratory_lap(int key_frames);

/// What the head measures: `count` points at pixels spread by a counter-based generator, column noise in both
/// images so that the disparity has the standard deviation sigma_disparity_px, and depth up to max_depth_m.
std::vector<MapPoint> measure(const RoomWorld& world, const StereoRig& rig, const Pose& T_map_left, int count,
                              double sigma_disparity_px, uint64_t seed);

enum CellSight : uint8_t { kUnseen = 0, kCrossed = 1, kSurfaceSeen = 2 };

/// What pixel rays between the heights saw of every cell: they went through it, or ended on a surface in it.
std::vector<uint8_t> visible_cells(const RoomWorld& world, const StereoRig& rig,
                                   const std::vector<Pose>& T_map_left, const GridGeometry& geometry,
                                   double z_min_m, double z_max_m, double max_range_m);

/// A map against the truth with a tolerance of one cell, as docs/metrics.md has it for map.*.
struct MapScore {
  double precision = 0;  ///< cells called occupied that are, or have an occupied neighbour
  double recall = 0;  ///< cells with a seen surface that are called occupied, or have a neighbour called so
  double f1 = 0;
  double free_recall = 0;    ///< share of the truly free, seen cells that the map calls free
  double false_free_m2 = 0;  ///< cells with a seen surface that the map calls free
};
MapScore score(const OccupancyMap& map, const OccupancyMap& truth, const std::vector<uint8_t>& sight);

}  // namespace groundloop::slam
