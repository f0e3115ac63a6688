#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// An estimated occupancy map against the exact one, over the cells that the true trajectory could see.
///
/// A scored cell is either a wall cell (truth occupied, and an upright face of it seen) or a free cell (truth
/// free and crossed by a ray). Not scored are occupied cells of which no upright face was seen: the inside of
/// things, and columns under a desk top, which a robot sees through below and cannot tell from free space in
/// a flat map. The estimate calls a cell occupied above 0.65, free below 0.35, else unknown; unknown is never
/// occupied.
struct MapScore {
  /// Strict counts over the scored cells, truth by call of the estimate.
  int wall_occupied = 0, wall_unknown = 0, wall_free = 0;
  int free_occupied = 0, free_unknown = 0, free_free = 0;

  /// With a tolerance of one cell (Chebyshev).
  int occupied_cells = 0;    ///< cells called occupied that were seen, or are neighbours of a wall cell
  int occupied_right = 0;    ///< of these: truth is occupied there or in one of the 8 neighbours
  int wall_found = 0;        ///< wall cells where the estimate is occupied there or in a neighbour
  int wall_called_free = 0;  ///< wall cells called free, with no neighbour called occupied

  double cell_m = 0;
  double squared_error = 0;  ///< sum of (estimated value - truth)^2 over the scored cells

  /// For every occupied cell of the estimate, seen or not: distance between its centre and the nearest wall
  /// cell's [m]; negative in front of the wall (in seen free space), positive in or behind it. Empty without
  /// wall cells.
  std::vector<double> wall_offsets_m;

  int wall_cells() const { return wall_occupied + wall_unknown + wall_free; }
  int free_cells() const { return free_occupied + free_unknown + free_free; }
  int scored_cells() const { return wall_cells() + free_cells(); }

  /// All below: none where the denominator is 0.
  std::optional<double> precision() const;  ///< occupied_right / occupied_cells
  std::optional<double> recall() const;     ///< wall_found / wall_cells
  std::optional<double> f1() const;         ///< harmonic mean; 0 when one of the two is 0 or the map is empty
  std::optional<double> iou() const;        ///< strict: of the class occupied
  std::optional<double> mcc() const;        ///< strict Matthews correlation, occupied against not occupied
  std::optional<double> brier() const;      ///< squared_error / scored_cells
  double false_free_m2() const { return wall_called_free * cell_m * cell_m; }
};

/// @param truth        exact map in the world frame
/// @param sight        sim::TruthWorld::visible_cells() of the same grid (0 unseen, 1 crossed, 2 surface
/// seen)
/// @param estimate     map in the map frame, any grid; read at the centres of the truth's cells (nearest
/// cell)
/// @param T_world_map  its heading and horizontal translation are used. True start pose: the raw frame, drift
/// and
///                     mapping error together; from alignment: mapping error alone
/// @throws std::invalid_argument when sight does not fit the grid
MapScore score_map(const slam::OccupancyMap& truth, const std::vector<uint8_t>& sight,
                   const slam::OccupancyMap& estimate, const slam::Pose& T_world_map);

/// map.{f1, iou, mcc, precision, recall, false_free_m2, wall_offset_mean_m, wall_offset_p95_m, brier}; absent
/// where it could not be measured. The mean offset keeps its sign, the 95th percentile is of the distances.
Metrics map_metrics(const MapScore& score, const std::string& prefix = "map.");

}  // namespace groundloop::bench
