#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "slam/mapping/flog_options.h"
#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// Memberships of one cell in the fuzzy sets "empty", "occupied" and "has been observed", each in [0, 1].
struct FlogCell {
  float empty = 0;
  float occupied = 0;
  float confidence = 0;

  /// mu_K (mu_O - mu_E) in [-1, 1]: -1 surely free, 0 unknown or contradictory, 1 surely occupied.
  float belief() const { return confidence * (occupied - empty); }
  /// Map value in [0, 1]: 0 free, 1/2 unknown, 1 occupied.
  float value() const { return 0.5F + 0.5F * belief(); }
};

/// Algebraic sum, the fuzzy union a + b - a b.
inline float fuzzy_or(float a, float b) { return a + b - a * b; }

/// Global fuzzy logic-based occupancy grid (FLOG) of the map frame's horizontal plane, one plane of cells for
/// every height layer and, without FlogOptions::fuse_layers, one more for the whole band. It grows as the
/// robot moves.
class FlogGrid {
 public:
  explicit FlogGrid(const FlogOptions& options);

  /// Adds what a local map says of one cell (paper section 2.4: the local map is added to the global one):
  ///   mu_O <- (mu_O + mu_O') (1 - lambda mu_K' mu_E' (1 - mu_O'))   with + the fuzzy union, ' the local map,
  ///   mu_E alike with E and O exchanged, mu_K <- mu_K + mu_K'.
  /// @param col, row  cell [col h, (col+1) h) x [row h, (row+1) h) of the map frame; any integers
  /// @param plane     height layer, lowest 0, or layer_count() for the band
  void add(int col, int row, int plane, const FlogCell& local);

  /// Cell of one plane; unobserved where nothing was ever added.
  FlogCell cell(int col, int row, int plane) const;

  /// Number of planes: the layers, and the band unless layers are fused.
  int plane_count() const { return plane_count_; }

  /// The 2-D map of the whole band over the rectangle of observed cells (empty when there are none).
  OccupancyMap map() const;
  /// One map a height layer, lowest first, on the same rectangle as map().
  std::vector<OccupancyMap> layers() const;

 private:
  static constexpr int kBlockBits = 6;
  static constexpr int kBlockSide = 1 << kBlockBits;  ///< cells along the side of a block
  using Block = std::vector<FlogCell>;                ///< [row][col][plane]; no cells: never touched

  Block& block_at(int block_col, int block_row);
  const Block* find_block(int block_col, int block_row) const;
  size_t index_in_block(int col, int row, int plane) const;
  OccupancyMap unknown_map() const;

  FlogOptions options_;
  int plane_count_;
  std::vector<Block> blocks_;  ///< directory: rectangle of blocks, row by row
  int block_col_min_ = 0, block_row_min_ = 0, block_cols_ = 0, block_rows_ = 0;
  int col_min_ = 0, row_min_ = 0, col_end_ = 0, row_end_ = 0;  ///< rectangle of observed cells
};

/// One belief out of those of the layers above each other: occupied as soon as one layer is, otherwise as
/// free as the layer that is known best to be free.
/// @param beliefs  FlogCell::belief() of `count` layers
float fused_belief(const float* beliefs, int count);

}  // namespace groundloop::slam
