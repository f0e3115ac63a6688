#include "slam/mapping/local_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr size_t kStride = 89, kLeap = 55;  ///< no common divisor
constexpr int kSweptCells = 3;              ///< in a row, after which a ray has nothing to add

/// Steps along a straight line from cell to cell (Amanatides and Woo, Eurographics 1987). Which border comes
/// next is as good as chance, so both are carried on without a branch.
class GridWalk {
 public:
  /// @param at         where the walk starts [m]; it has covered no distance there
  /// @param direction  unit vector
  GridWalk(const Eigen::Vector2d& at, const Eigen::Vector2d& direction, double cell_m)
      : col(static_cast<int>(std::floor(at.x() / cell_m))),
        row(static_cast<int>(std::floor(at.y() / cell_m))),
        col_step_(direction.x() < 0 ? -1 : 1),
        row_step_(direction.y() < 0 ? -1 : 1) {
    const auto distance_m = [&](int axis, int cell) {
      const double border_m = (cell + (direction[axis] < 0 ? 0 : 1)) * cell_m;
      const double speed = std::abs(direction[axis]);
      return speed > 0 ? std::abs(border_m - at[axis]) / speed : kNever;
    };
    const auto width_m = [&](int axis) {
      const double speed = std::abs(direction[axis]);
      return speed > 0 ? cell_m / speed : kNever;
    };
    next_col_m_ = distance_m(0, col), next_row_m_ = distance_m(1, row);
    col_width_m_ = width_m(0), row_width_m_ = width_m(1);
  }

  /// Distance at which the line leaves the cell.
  double exit_m() const { return std::min(next_col_m_, next_row_m_); }

  void advance() {
    const bool to_col = next_col_m_ < next_row_m_;
    col += to_col ? col_step_ : 0;
    row += to_col ? 0 : row_step_;
    next_col_m_ += to_col ? col_width_m_ : 0;
    next_row_m_ += to_col ? 0 : row_width_m_;
  }

  int col, row;

 private:
  int col_step_, row_step_;
  double next_col_m_, next_row_m_, col_width_m_, row_width_m_;
};

/// Layer that holds a height; the outermost reach on.
int layer_of(const std::vector<double>& heights_m, double z_m) {
  int below = 0;
  for (const double height_m : heights_m) below += height_m <= z_m ? 1 : 0;
  return std::clamp(below - 1, 0, static_cast<int>(heights_m.size()) - 2);
}

/// Layer of a height along a ray, followed upward or downward as the ray proceeds.
class LayerWalk {
 public:
  LayerWalk(const std::vector<double>& heights_m, double z_head_m, double slope)
      : heights_m_(heights_m), z_head_m_(z_head_m), slope_(slope), layer_(layer_of(heights_m, z_head_m)) {
    find_next_border();
  }

  int layer_at(double rho_m) {
    while (rho_m > next_m_) {
      layer_ += slope_ > 0 ? 1 : -1;
      find_next_border();
    }
    return layer_;
  }

 private:
  void find_next_border() {
    const int border = slope_ > 0 ? layer_ + 1 : layer_;
    const bool outermost = border == 0 || border + 1 == static_cast<int>(heights_m_.size());
    next_m_ = outermost || slope_ == 0 ? kNever : (heights_m_[border] - z_head_m_) / slope_;
  }

  const std::vector<double>& heights_m_;
  double z_head_m_, slope_, next_m_ = kNever;
  int layer_;
};

}  // namespace

std::optional<MapPoint> map_point(const StereoRig& rig, const Pose& T_map_left, const Eigen::Vector3d& uvu,
                                  double sigma_disparity_px, double weight) {
  const std::optional<Eigen::Vector3d> p_left = rig.triangulate(uvu);
  if (!p_left) return std::nullopt;
  const Eigen::Vector3d ray_map = T_map_left.linear() * *p_left;
  const double range_m = ray_map.head<2>().norm();
  if (!(range_m > 0)) return std::nullopt;
  // Standard deviation along the horizontal direction u of the ray: sqrt(u' R C R' u).
  const Eigen::Vector3d u_map(ray_map.x() / range_m, ray_map.y() / range_m, 0);
  const Eigen::Vector3d u_left = T_map_left.linear().transpose() * u_map;
  const Eigen::Matrix3d C_left = point_covariance(rig, uvu, sigma_disparity_px / std::sqrt(2.0));
  return MapPoint{T_map_left.translation() + ray_map, std::sqrt(u_left.dot(C_left * u_left)), weight};
}

LocalMap::LocalMap(const FlogOptions& options, const StereoRig& rig)
    : options_(options),
      rho_v_m_(std::sqrt(options.sigma_max_m * rig.fx_px * rig.baseline_m / options.sigma_disparity_px)),
      plane_count_(options.layer_count() + (options.fuse_layers ? 0 : 1)) {}

bool LocalMap::in_band(double z_m) const {
  return z_m > options_.layer_heights_m.front() && z_m < options_.layer_heights_m.back();
}

void LocalMap::add_key_frame(const Eigen::Vector3d& head_map, std::span<const MapPoint> points) {
  cover(head_map, points);
  // Far from each other in turn, not row by row, so that most rays soon run between others.
  for (size_t first = 0; first < kStride; ++first) {
    for (size_t i = first * kLeap % kStride; i < points.size(); i += kStride) trace(head_map, points[i]);
  }
  close_key_frame();
}

double LocalMap::margin_m(const MapPoint& point) const {
  return std::max(options_.cell_m, 2 * point.sigma_m);
}

void LocalMap::cover(const Eigen::Vector3d& head_map, std::span<const MapPoint> points) {
  Eigen::Array2d low = head_map.head<2>(), high = low;
  for (const MapPoint& point : points) {
    const Eigen::Array2d to = (point.p_map - head_map).head<2>();
    const double range_m = to.matrix().norm();
    if (!(range_m > 0) || range_m > options_.max_range_m) continue;
    const Eigen::Array2d end = head_map.head<2>().array() + to * (1 + margin_m(point) / range_m);
    low = low.min(end), high = high.max(end);
  }
  // One cell more on every side, so that rounding never leads a walk out of the window.
  int col_min = static_cast<int>(std::floor(low.x() / options_.cell_m)) - 1;
  int row_min = static_cast<int>(std::floor(low.y() / options_.cell_m)) - 1;
  int col_end = static_cast<int>(std::floor(high.x() / options_.cell_m)) + 2;
  int row_end = static_cast<int>(std::floor(high.y() / options_.cell_m)) + 2;
  if (!empty()) {
    col_min = std::min(col_min, col_min_), col_end = std::max(col_end, col_min_ + cols_);
    row_min = std::min(row_min, row_min_), row_end = std::max(row_end, row_min_ + rows_);
  }
  move_window(col_min, row_min, col_end - col_min, row_end - row_min);
}

void LocalMap::move_window(int col_min, int row_min, int cols, int rows) {
  // Lift what was observed, with its place in the new window, and put it down again.
  moved_.clear();
  for (uint32_t& index : observed_) {
    const auto [col, row, plane] = place_of(index);
    moved_.push_back(cells_[index]);
    cells_[index] = {};
    index = static_cast<uint32_t>(
        ((row - row_min) * static_cast<size_t>(cols) + (col - col_min)) * plane_count_ + plane);
  }
  col_min_ = col_min, row_min_ = row_min, cols_ = cols, rows_ = rows;
  const size_t size = static_cast<size_t>(cols) * rows * plane_count_;
  if (size > cells_.size()) cells_.resize(size), key_frame_.resize(size);
  for (size_t i = 0; i < observed_.size(); ++i) cells_[observed_[i]] = moved_[i];
}

LocalMap::Place LocalMap::place_of(uint32_t index) const {
  const int plane = static_cast<int>(index) % plane_count_, cell = static_cast<int>(index) / plane_count_;
  return {col_min_ + cell % cols_, row_min_ + cell / cols_, plane};
}

void LocalMap::trace(const Eigen::Vector3d& head_map, const MapPoint& point) {
  const Eigen::Vector3d to = point.p_map - head_map;
  const double range_m = to.head<2>().norm();
  if (!(range_m > 0) || range_m > options_.max_range_m) return;
  const double trust = point.weight / (1 + std::exp(8 * (range_m - rho_v_m_) / rho_v_m_));
  if (!(trust > 0)) return;
  const Eigen::Vector2d direction = to.head<2>() / range_m;
  const double slope = to.z() / range_m;
  const double margin = margin_m(point);

  // Part of the ray that is inside the band. An obstacle's uncertain end counts for the layer of the
  // obstacle.
  const bool obstacle = in_band(point.p_map.z());
  double begin_m = 0, end_m = obstacle ? range_m + margin : range_m;
  if (slope != 0) {
    const double low_m = (options_.layer_heights_m.front() - head_map.z()) / slope;
    const double high_m = (options_.layer_heights_m.back() - head_map.z()) / slope;
    begin_m = std::max(begin_m, std::min(low_m, high_m));
    if (!obstacle) end_m = std::min(end_m, std::max(low_m, high_m));
  } else if (!obstacle) {
    return;
  }
  if (!(begin_m < end_m)) return;

  const auto k_occupied =
      obstacle ? options_.k_occupied * trust * std::min(1.0, 2 * options_.cell_m / margin) : 0.0;
  const FlogCell sure{static_cast<float>(options_.k_empty * trust), 0,
                      static_cast<float>(options_.k_confidence * trust)};

  // From the end back to the head: rays come together there. Once one runs between a steeper and a flatter
  // one that went the same way through the same layers, the rest of its way has been swept too.
  LayerWalk layers(options_.layer_heights_m, head_map.z() + slope * end_m, -slope);
  GridWalk walk(head_map.head<2>() + end_m * direction, -direction, options_.cell_m);
  double rho_out_m = end_m, rho_m = end_m;
  const auto enter = [&] {
    const double rho_in_m = std::max(end_m - walk.exit_m(), begin_m);
    rho_m = 0.5 * (rho_in_m + rho_out_m);
    return rho_in_m;
  };
  const auto index = [&] { return index_of(walk.col, walk.row); };

  const int layer_of_point = layer_of(options_.layer_heights_m, point.p_map.z());
  for (; rho_out_m > begin_m; walk.advance()) {
    const double rho_in_m = enter();
    const double x = (range_m - rho_m) / margin;
    if (x > 1) break;
    rho_out_m = rho_in_m;
    FlogCell evidence = sure;
    evidence.empty *= static_cast<float>(x > 0 ? x * x : 0);
    evidence.occupied = static_cast<float>(k_occupied * std::max(0.0, 1 - x * x));
    strongest(index(), obstacle ? layer_of_point : layers.layer_at(end_m - rho_m), evidence);
  }
  for (int swept_cells = 0; rho_out_m > begin_m && swept_cells < kSweptCells; walk.advance()) {
    rho_out_m = enter();
    const int layer = layers.layer_at(end_m - rho_m);
    KeyFrameCell& known = key_frame_[index() + layer];
    const bool known_free =
        known.evidence.empty >= sure.empty && known.evidence.confidence >= sure.confidence;
    const bool swept = known.covers(static_cast<float>(slope));
    swept_cells = known_free && swept ? swept_cells + 1 : 0;
    if (!known_free || !options_.fuse_layers) strongest(index(), layer, sure);
  }
}

size_t LocalMap::index_of(int col, int row) const {
  return (static_cast<size_t>(row - row_min_) * cols_ + (col - col_min_)) * plane_count_;
}

bool LocalMap::KeyFrameCell::covers(float slope) {
  if (slope >= low && slope <= high) return true;
  low = std::min(low, slope);
  high = std::max(high, slope);
  return false;
}

/// Of a cell's layer, and of the band when that has a plane.
void LocalMap::strongest(size_t index, int layer, const FlogCell& evidence) {
  const auto raise = [&](size_t at) {
    FlogCell& cell = key_frame_[at].evidence;
    if (cell.confidence == 0) in_key_frame_.push_back(static_cast<uint32_t>(at));
    cell.empty = std::max(cell.empty, evidence.empty);
    cell.occupied = std::max(cell.occupied, evidence.occupied);
    cell.confidence = std::max(cell.confidence, evidence.confidence);
  };
  raise(index + layer);
  if (!options_.fuse_layers) raise(index + options_.layer_count());
}

void LocalMap::close_key_frame() {
  for (const uint32_t index : in_key_frame_) {
    FlogCell& cell = cells_[index];
    FlogCell& evidence = key_frame_[index].evidence;
    if (cell.confidence == 0) observed_.push_back(index);
    if (options_.ends_deny_empty) evidence.empty *= 1 - evidence.occupied;
    cell.empty = fuzzy_or(cell.empty, evidence.empty);
    cell.occupied = fuzzy_or(cell.occupied, evidence.occupied);
    cell.confidence = fuzzy_or(cell.confidence, evidence.confidence);
    key_frame_[index] = {};
  }
  in_key_frame_.clear();
}

void LocalMap::add_to(FlogGrid& global) {
  for (const uint32_t index : observed_) {
    const auto [col, row, plane] = place_of(index);
    global.add(col, row, plane, cells_[index]);
    cells_[index] = {};
  }
  observed_.clear();
}

}  // namespace groundloop::slam
