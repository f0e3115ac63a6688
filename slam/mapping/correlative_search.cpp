#include "slam/mapping/correlative_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "slam/mapping/occupied_field.h"

namespace groundloop::slam {
namespace {

constexpr int kBlock = 4;               ///< places along a side of a block
constexpr double kSecondAtLeast = 0.5;  ///< of the best score

/// A place, as steps of the lattice from the window's lowest corner.
struct Place {
  int turn = 0, row = 0, col = 0;
};

/// Neighbouring places of one turn, from the lowest on, and a bound of their scores.
struct Block {
  Place lowest;
  float bound = 0;
};

/// The lattice of places of one search.
class Lattice {
 public:
  Lattice(const OccupancyMap& global, std::span<const WeightedPoint> points, const SearchWindow& window);

  /// Blocks, highest bound first.
  std::vector<Block> blocks() const;
  /// Calls visit(place, score) for every place of a block.
  template <class Visit>
  void open(const Block& block, const Visit& visit) const;
  bool is_local_maximum(const Place& place, float score) const;
  bool is_at_edge(const Place& place) const;
  SearchPeak peak(const Place& place, float score) const;

 private:
  float score(const Place& place) const;
  std::vector<float> block_maxima() const;

  GridGeometry geometry_;
  std::vector<float> field_;
  std::vector<float> weight_;
  SearchWindow window_;
  double turn_rad_ = 0;
  int turns_ = 1, rows_ = 1, cols_ = 1;
  std::vector<int> cell_;  ///< [turn][point]: index of its cell in the field at row 0, col 0
};

double reach_m(std::span<const WeightedPoint> points) {
  double reach_m = 0;
  for (const WeightedPoint& point : points) reach_m = std::max(reach_m, point.p_m.norm());
  return reach_m;
}

Lattice::Lattice(const OccupancyMap& global, std::span<const WeightedPoint> points,
                 const SearchWindow& window)
    : window_(window) {
  const double cell_m = global.geometry.cell_m;
  turn_rad_ = cell_m / std::max(cell_m, reach_m(points));
  const auto steps = [](double half, double step) {
    return 2 * static_cast<int>(std::ceil(half / step - 1e-9)) + 1;
  };
  turns_ = steps(window.half_rad, turn_rad_);
  rows_ = steps(window.half_m.y(), cell_m), cols_ = steps(window.half_m.x(), cell_m);

  // The part of the map that the points can come to, with what the last block reaches beyond the window.
  const Eigen::Vector2d half_m = Eigen::Vector2d(cols_ / 2, rows_ / 2) * cell_m;
  const Eigen::Vector2d around_m =
      half_m + Eigen::Vector2d::Constant(reach_m(points) + (2 * kBlock + 1) * cell_m);
  const OccupiedField field(global, window.centre_m - around_m, window.centre_m + around_m);
  geometry_ = field.geometry();
  field_ = field.at_centres();

  for (const WeightedPoint& point : points) weight_.push_back(static_cast<float>(point.weight));
  for (int turn = 0; turn < turns_; ++turn) {
    const double yaw_rad = peak({turn, 0, 0}, 0).yaw_rad;
    const Eigen::Matrix2d R_map_points = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
    for (const WeightedPoint& point : points) {
      const Eigen::Vector2d p_m = window.centre_m - half_m + R_map_points * point.p_m;
      cell_.push_back(
          static_cast<int>(geometry_.index(geometry_.col_of(p_m.x()), geometry_.row_of(p_m.y()))));
    }
  }
}

/// For every cell the largest value of the block that begins there.
std::vector<float> Lattice::block_maxima() const {
  std::vector<float> along_row(field_), maxima(field_);
  const auto along = [](const std::vector<float>& in, size_t step, std::vector<float>& out) {
    for (size_t i = 0; i + (kBlock - 1) * step < in.size(); ++i) {
      out[i] = std::max({in[i], in[i + step], in[i + 2 * step], in[i + 3 * step]});
    }
  };
  static_assert(kBlock == 4);
  along(field_, 1, along_row);
  along(along_row, static_cast<size_t>(geometry_.cols), maxima);
  return maxima;
}

std::vector<Block> Lattice::blocks() const {
  const std::vector<float> maxima = block_maxima();
  const size_t points = weight_.size();
  std::vector<Block> blocks;
  for (int turn = 0; turn < turns_; ++turn) {
    const int* cell = &cell_[turn * points];
    for (int row = 0; row < rows_; row += kBlock) {
      for (int col = 0; col < cols_; col += kBlock) {
        const float* maximum = &maxima[geometry_.index(col, row)];
        float bound = 0;
        for (size_t i = 0; i < points; ++i) bound += weight_[i] * maximum[cell[i]];
        blocks.push_back({{turn, row, col}, bound});
      }
    }
  }
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.bound > b.bound; });
  return blocks;
}

template <class Visit>
void Lattice::open(const Block& block, const Visit& visit) const {
  // The points' order is that of the bound's sum, so that rounding cannot lift a score above its bound.
  const size_t points = weight_.size();
  const int* cell = &cell_[block.lowest.turn * points];
  const float* field = &field_[geometry_.index(block.lowest.col, block.lowest.row)];
  std::array<float, kBlock * kBlock> scores{};
  for (size_t i = 0; i < points; ++i) {
    for (int row = 0; row < kBlock; ++row) {
      const float* values = field + cell[i] + row * geometry_.cols;
      for (int col = 0; col < kBlock; ++col) scores[row * kBlock + col] += weight_[i] * values[col];
    }
  }
  for (int i = 0; i < kBlock * kBlock; ++i) {
    const Place place{block.lowest.turn, block.lowest.row + i / kBlock, block.lowest.col + i % kBlock};
    if (place.row < rows_ && place.col < cols_) visit(place, scores[i]);
  }
}

float Lattice::score(const Place& place) const {
  const size_t points = weight_.size();
  const int* cell = &cell_[place.turn * points];
  const float* field = &field_[geometry_.index(place.col, place.row)];
  float sum = 0;
  for (size_t i = 0; i < points; ++i) sum += weight_[i] * field[cell[i]];
  return sum;
}

bool Lattice::is_local_maximum(const Place& place, float score_here) const {
  for (int i = 0; i < 27; ++i) {
    const Place next{place.turn + i / 9 - 1, place.row + i / 3 % 3 - 1, place.col + i % 3 - 1};
    const bool inside = next.turn >= 0 && next.turn < turns_ && next.row >= 0 && next.row < rows_ &&
                        next.col >= 0 && next.col < cols_;
    if (inside && score(next) > score_here) return false;
  }
  return true;
}

bool Lattice::is_at_edge(const Place& place) const {
  const auto at_edge = [](int step, int steps) { return steps > 1 && (step == 0 || step + 1 == steps); };
  return at_edge(place.turn, turns_) || at_edge(place.row, rows_) || at_edge(place.col, cols_);
}

SearchPeak Lattice::peak(const Place& place, float score) const {
  const Eigen::Vector2d steps(place.col - cols_ / 2, place.row - rows_ / 2);
  return {window_.centre_m + steps * geometry_.cell_m,
          window_.yaw_rad + (place.turn - turns_ / 2) * turn_rad_, score};
}

bool apart(const SearchPeak& a, const SearchPeak& b, const Separation& separation) {
  return (a.centre_m - b.centre_m).norm() > separation.m || std::abs(a.yaw_rad - b.yaw_rad) > separation.rad;
}

}  // namespace

SearchResult search_peaks(const OccupancyMap& global, std::span<const WeightedPoint> points,
                          const SearchWindow& window, const Separation& separation) {
  const Lattice lattice(global, points, window);
  const std::vector<Block> blocks = lattice.blocks();
  SearchResult result;
  result.best.score = -1;
  for (const Block& block : blocks) {
    if (block.bound <= result.best.score) break;
    lattice.open(block, [&](const Place& place, float score) {
      if (score <= result.best.score) return;
      result.best = lattice.peak(place, score);
      result.at_edge = lattice.is_at_edge(place);
    });
  }

  double to_beat = kSecondAtLeast * result.best.score;
  for (const Block& block : blocks) {
    if (block.bound <= to_beat) break;
    lattice.open(block, [&](const Place& place, float score) {
      const SearchPeak peak = lattice.peak(place, score);
      if (score <= to_beat || !apart(peak, result.best, separation)) return;
      if (!lattice.is_local_maximum(place, score)) return;
      result.second = peak;
      to_beat = score;
    });
  }
  return result;
}

}  // namespace groundloop::slam
