#include "bench/metrics/truth/map_score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "sim/truth/truth_world.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector2d;
using slam::OccupancyMap;

/// The heading and the horizontal part of a pose.
Eigen::Isometry2d planar(const slam::Pose& T) {
  Eigen::Isometry2d T_planar = Eigen::Isometry2d::Identity();
  T_planar.linear() = Eigen::Rotation2Dd(slam::yaw_rad(T.linear())).toRotationMatrix();
  T_planar.translation() = T.translation().head<2>();
  return T_planar;
}

/// The estimate as one value a cell of the truth's grid, with a border of one cell so that every scored cell
/// has eight neighbours.
class Resampled {
 public:
  Resampled(const slam::GridGeometry& grid, const OccupancyMap& estimate,
            const Eigen::Isometry2d& T_world_map)
      : cols_(grid.cols + 2) {
    const Eigen::Isometry2d T_map_world = T_world_map.inverse();
    for (int row = -1; row <= grid.rows; ++row) {
      for (int col = -1; col <= grid.cols; ++col) {
        const Vector2d p_map = T_map_world * grid.centre_m(col, row);
        value_.push_back(estimate.at_point(p_map.x(), p_map.y()));
      }
    }
  }
  float at(int col, int row) const { return value_[static_cast<size_t>(row + 1) * cols_ + col + 1]; }
  bool occupied(int col, int row) const { return at(col, row) > OccupancyMap::kOccupiedAbove; }
  bool free(int col, int row) const { return at(col, row) < OccupancyMap::kFreeBelow; }

 private:
  int cols_;
  std::vector<float> value_;
};

/// True where `is_occupied(col, row)` holds for the cell or one of its eight neighbours.
template <class IsOccupied>
bool near(int col, int row, const IsOccupied& is_occupied) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (is_occupied(col + dx, row + dy)) return true;
    }
  }
  return false;
}

double squared_distance_to_nearest(const Vector2d& p, const std::vector<Vector2d>& candidates) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector2d& candidate : candidates) least = std::min(least, (candidate - p).squaredNorm());
  return least;
}

std::optional<double> ratio(double numerator, double denominator) {
  if (denominator == 0) return std::nullopt;
  return numerator / denominator;
}

}  // namespace

std::optional<double> MapScore::precision() const { return ratio(occupied_right, occupied_cells); }
std::optional<double> MapScore::recall() const { return ratio(wall_found, wall_cells()); }
std::optional<double> MapScore::brier() const { return ratio(squared_error, scored_cells()); }

std::optional<double> MapScore::f1() const {
  if (wall_cells() == 0) return std::nullopt;
  const double p = precision().value_or(0), r = *recall();
  return p + r > 0 ? 2 * p * r / (p + r) : 0;
}

std::optional<double> MapScore::iou() const { return ratio(wall_occupied, wall_cells() + free_occupied); }

std::optional<double> MapScore::mcc() const {
  const double tp = wall_occupied, fp = free_occupied;
  const double fn = wall_unknown + wall_free, tn = free_unknown + free_free;
  return ratio(tp * tn - fp * fn, std::sqrt((tp + fp) * (tp + fn) * (tn + fp) * (tn + fn)));
}

MapScore score_map(const OccupancyMap& truth, const std::vector<uint8_t>& sight, const OccupancyMap& estimate,
                   const slam::Pose& T_world_map) {
  const slam::GridGeometry& grid = truth.geometry;
  if (sight.size() != grid.cells()) throw std::invalid_argument("score_map: sight does not fit the grid");
  const Eigen::Isometry2d T = planar(T_world_map);
  const Resampled called(grid, estimate, T);
  const auto called_occupied = [&](int col, int row) { return called.occupied(col, row); };
  const auto truly_occupied = [&](int col, int row) {
    return grid.contains(col, row) && truth.at(col, row) > 0.5F;
  };
  const auto is_wall = [&](int col, int row) {
    return truly_occupied(col, row) && sight[grid.index(col, row)] == sim::kFaceSeen;
  };

  MapScore score;
  score.cell_m = grid.cell_m;
  std::vector<Vector2d> wall_m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const bool seen = sight[grid.index(col, row)] != sim::kUnseen;
      const bool occupied = called.occupied(col, row), free = called.free(col, row);
      if (occupied && (seen || near(col, row, is_wall))) {
        ++score.occupied_cells;
        score.occupied_right += near(col, row, truly_occupied);
      }
      if (!seen) continue;
      const bool truly = truly_occupied(col, row);
      if (is_wall(col, row)) {
        wall_m.push_back(grid.centre_m(col, row));
        ++(occupied ? score.wall_occupied : free ? score.wall_free : score.wall_unknown);
        const bool found = near(col, row, called_occupied);
        score.wall_found += found;
        score.wall_called_free += free && !found;
      } else if (!truly) {
        ++(occupied ? score.free_occupied : free ? score.free_free : score.free_unknown);
      } else {
        continue;
      }
      const double error = called.at(col, row) - (truly ? 1.0 : 0.0);
      score.squared_error += error * error;
    }
  }
  if (wall_m.empty()) return score;

  const slam::GridGeometry& own = estimate.geometry;
  for (int row = 0; row < own.rows; ++row) {
    for (int col = 0; col < own.cols; ++col) {
      if (!(estimate.at(col, row) > OccupancyMap::kOccupiedAbove)) continue;
      const Vector2d p_world = T * own.centre_m(col, row);
      const int truth_col = grid.col_of(p_world.x()), truth_row = grid.row_of(p_world.y());
      const bool in_front = grid.contains(truth_col, truth_row) && !truly_occupied(truth_col, truth_row) &&
                            sight[grid.index(truth_col, truth_row)] != sim::kUnseen;
      const double distance_m = std::sqrt(squared_distance_to_nearest(p_world, wall_m));
      score.wall_offsets_m.push_back(in_front ? -distance_m : distance_m);
    }
  }
  return score;
}

Metrics map_metrics(const MapScore& score, const std::string& prefix) {
  Metrics metrics;
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) metrics[prefix + name] = *value;
  };
  add("f1", score.f1());
  add("iou", score.iou());
  add("mcc", score.mcc());
  add("precision", score.precision());
  add("recall", score.recall());
  add("brier", score.brier());
  if (score.wall_cells() > 0) metrics[prefix + "false_free_m2"] = score.false_free_m2();
  if (!score.wall_offsets_m.empty()) {
    const auto& offsets = score.wall_offsets_m;
    metrics[prefix + "wall_offset_mean_m"] =
        std::accumulate(offsets.begin(), offsets.end(), 0.0) / static_cast<double>(offsets.size());
    std::vector<double> distances(offsets.size());
    std::transform(offsets.begin(), offsets.end(), distances.begin(), [](double x) { return std::abs(x); });
    std::sort(distances.begin(), distances.end());
    // the smallest distance that 95 % of the cells do not exceed
    const auto rank = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(distances.size()) - 1e-9));
    metrics[prefix + "wall_offset_p95_m"] = distances[rank - 1];
  }
  return metrics;
}

}  // namespace groundloop::bench
