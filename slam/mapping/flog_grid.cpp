#include "slam/mapping/flog_grid.h"

#include <algorithm>

namespace groundloop::slam {
namespace {

/// Block that holds a cell, and the cell's place in it; right for negative cells too.
int block_of(int cell, int bits) { return cell >> bits; }
int place_in_block(int cell, int side) { return cell & (side - 1); }

}  // namespace

FlogGrid::FlogGrid(const FlogOptions& options)
    : options_(options), plane_count_(options.layer_count() + (options.fuse_layers ? 0 : 1)) {}

size_t FlogGrid::index_in_block(int col, int row, int plane) const {
  const int place = place_in_block(row, kBlockSide) * kBlockSide + place_in_block(col, kBlockSide);
  return static_cast<size_t>(place) * plane_count_ + plane;
}

const FlogGrid::Block* FlogGrid::find_block(int block_col, int block_row) const {
  const int c = block_col - block_col_min_, r = block_row - block_row_min_;
  if (c < 0 || r < 0 || c >= block_cols_ || r >= block_rows_) return nullptr;
  const Block& block = blocks_[static_cast<size_t>(r) * block_cols_ + c];
  return block.empty() ? nullptr : &block;
}

FlogGrid::Block& FlogGrid::block_at(int block_col, int block_row) {
  int c = block_col - block_col_min_, r = block_row - block_row_min_;
  if (c < 0 || r < 0 || c >= block_cols_ || r >= block_rows_) {
    // A larger directory; the blocks themselves stay where they are in memory.
    const bool first = blocks_.empty();
    const int col_min = first ? block_col : std::min(block_col, block_col_min_);
    const int row_min = first ? block_row : std::min(block_row, block_row_min_);
    const int col_end = std::max(block_col + 1, first ? block_col : block_col_min_ + block_cols_);
    const int row_end = std::max(block_row + 1, first ? block_row : block_row_min_ + block_rows_);
    std::vector<Block> larger(static_cast<size_t>(col_end - col_min) * (row_end - row_min));
    for (int old_r = 0; old_r < block_rows_; ++old_r) {
      for (int old_c = 0; old_c < block_cols_; ++old_c) {
        const size_t row = old_r + block_row_min_ - row_min, col = old_c + block_col_min_ - col_min;
        larger[row * (col_end - col_min) + col] =
            std::move(blocks_[static_cast<size_t>(old_r) * block_cols_ + old_c]);
      }
    }
    blocks_ = std::move(larger);
    block_col_min_ = col_min, block_row_min_ = row_min;
    block_cols_ = col_end - col_min, block_rows_ = row_end - row_min;
    c = block_col - block_col_min_, r = block_row - block_row_min_;
  }
  Block& block = blocks_[static_cast<size_t>(r) * block_cols_ + c];
  if (block.empty()) block.resize(static_cast<size_t>(kBlockSide) * kBlockSide * plane_count_);
  return block;
}

void FlogGrid::add(int col, int row, int plane, const FlogCell& local) {
  Block& block = block_at(block_of(col, kBlockBits), block_of(row, kBlockBits));
  FlogCell& global = block[index_in_block(col, row, plane)];
  const auto lambda = static_cast<float>(options_.lambda);
  global.occupied = fuzzy_or(global.occupied, local.occupied) *
                    (1 - lambda * local.confidence * local.empty * (1 - local.occupied));
  global.empty = fuzzy_or(global.empty, local.empty) *
                 (1 - lambda * local.confidence * local.occupied * (1 - local.empty));
  global.confidence = fuzzy_or(global.confidence, local.confidence);

  const bool first = col_end_ == col_min_;
  col_min_ = first ? col : std::min(col_min_, col);
  row_min_ = first ? row : std::min(row_min_, row);
  col_end_ = first ? col + 1 : std::max(col_end_, col + 1);
  row_end_ = first ? row + 1 : std::max(row_end_, row + 1);
}

FlogCell FlogGrid::cell(int col, int row, int plane) const {
  const Block* block = find_block(block_of(col, kBlockBits), block_of(row, kBlockBits));
  return block == nullptr ? FlogCell{} : (*block)[index_in_block(col, row, plane)];
}

OccupancyMap FlogGrid::unknown_map() const {
  OccupancyMap map;
  map.geometry = {options_.cell_m, col_min_ * options_.cell_m, row_min_ * options_.cell_m,
                  col_end_ - col_min_, row_end_ - row_min_};
  map.value.assign(map.geometry.cells(), OccupancyMap::kUnknown);
  return map;
}

OccupancyMap FlogGrid::map() const {
  OccupancyMap map = unknown_map();
  const int layers = options_.layer_count();
  std::vector<float> beliefs(layers);
  for (int row = row_min_; row < row_end_; ++row) {
    for (int col = col_min_; col < col_end_; ++col) {
      float& value = map.value[map.geometry.index(col - col_min_, row - row_min_)];
      if (!options_.fuse_layers) {
        value = cell(col, row, layers).value();
        continue;
      }
      for (int layer = 0; layer < layers; ++layer) beliefs[layer] = cell(col, row, layer).belief();
      value = 0.5F + 0.5F * fused_belief(beliefs.data(), layers);
    }
  }
  return map;
}

std::vector<OccupancyMap> FlogGrid::layers() const {
  std::vector<OccupancyMap> maps(options_.layer_count(), unknown_map());
  for (size_t layer = 0; layer < maps.size(); ++layer) {
    for (int row = row_min_; row < row_end_; ++row) {
      for (int col = col_min_; col < col_end_; ++col) {
        maps[layer].value[maps[layer].geometry.index(col - col_min_, row - row_min_)] =
            cell(col, row, static_cast<int>(layer)).value();
      }
    }
  }
  return maps;
}

float fused_belief(const float* beliefs, int count) {
  float occupied = 0, free = 0;
  for (int i = 0; i < count; ++i) {
    occupied = std::max(occupied, beliefs[i]);
    free = std::max(free, -beliefs[i]);
  }
  // The free layers' say fades as another layer rises from unknown to occupied, so the value has no jump.
  constexpr float kSurelyOccupied = 2 * OccupancyMap::kOccupiedAbove - 1;
  return occupied - std::max(0.0F, 1 - occupied / kSurelyOccupied) * free;
}

}  // namespace groundloop::slam
