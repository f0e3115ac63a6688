#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "slam/mapping/flog_grid.h"
#include "slam/mapping/flog_options.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// One measured point as evidence for the map.
struct MapPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< z is the height above the floor [m]
  double sigma_m = 0;  ///< standard deviation of the horizontal distance from the head
  double weight = 1;   ///< trust in [0, 1]: Lorentz weight of the registration x min(1, frames tracked / 3)
};

/// Triangulates a stereo measurement and projects its covariance on the horizontal ray from the head.
/// @param uvu  (u_left, v, u_right) [px]
/// @param sigma_disparity_px  standard deviation of u_left - u_right
/// @return none when the point is at or beyond infinity, or straight above or below the head
std::optional<MapPoint> map_point(const StereoRig& rig, const Pose& T_map_left, const Eigen::Vector3d& uvu,
                                  double sigma_disparity_px, double weight);

/// Evidence gathered since the last update of the global map, already in the map frame.
///
/// A key frame's rays run from the head to its points. In a cell at horizontal distance rho along a ray of
/// length r, with d = max(cell, 2 sigma), trust q = weight * (1 - tanh(4 (r - rho_v) / rho_v)) / 2 and rho_v
/// the distance at which depth noise reaches sigma_max_m:
///   empty       k_E q              before r - d,  k_E q ((r - rho) / d)^2 up to r
///   occupied    k_O q min(1, 2 cell / d) (1 - ((rho - r) / d)^2)  where |rho - r| < d
///   confidence  k_K q              up to r + d
/// A key frame changes a cell once at most, by the largest of its rays' evidence, or cells near the head
/// would be sure at once. A point outside the height band is no obstacle, but its ray is free while it is
/// inside the band. Shape after Poloni, Ulivi, Vendittelli, Fuzzy Sets and Systems 69 (1995); paper
/// section 2.4.
class LocalMap {
 public:
  /// @param rig  gives the range at which points lose their say
  LocalMap(const FlogOptions& options, const StereoRig& rig);

  /// Adds the points seen from one head position: one key frame.
  void add_key_frame(const Eigen::Vector3d& head_map, std::span<const MapPoint> points);

  /// Adds everything gathered to the global map, in a fixed order, and starts again empty.
  void add_to(FlogGrid& global);

  bool empty() const { return observed_.empty(); }

 private:
  struct Place {
    int col, row, plane;
  };
  /// What the key frame being added says of a cell, and the rays that crossed it as free space: from the
  /// flattest to the steepest.
  struct KeyFrameCell {
    FlogCell evidence;                                   ///< largest over its rays
    float low = std::numeric_limits<float>::infinity();  ///< slope: rise over horizontal distance
    float high = -std::numeric_limits<float>::infinity();

    /// Whether a ray runs between them; if not, it is the new flattest or steepest.
    bool covers(float slope);
  };
  bool in_band(double z_m) const;
  double margin_m(const MapPoint& point) const;
  void cover(const Eigen::Vector3d& head_map, std::span<const MapPoint> points);
  void move_window(int col_min, int row_min, int cols, int rows);
  Place place_of(uint32_t index) const;
  void trace(const Eigen::Vector3d& head_map, const MapPoint& point);
  size_t index_of(int col, int row) const;
  void strongest(size_t index, int layer, const FlogCell& evidence);
  void close_key_frame();

  FlogOptions options_;
  double rho_v_m_;
  int plane_count_;

  /// Window of the lattice of cells, in cells: the arrays below hold [row][col][plane] of it. Both arrays are
  /// zero wherever their list does not point, so an empty window can be moved without touching them.
  int col_min_ = 0, row_min_ = 0, cols_ = 0, rows_ = 0;
  std::vector<FlogCell> cells_;     ///< the local map
  std::vector<uint32_t> observed_;  ///< cells of it that are not zero
  std::vector<KeyFrameCell> key_frame_;
  std::vector<uint32_t> in_key_frame_;  ///< cells of it that are not zero
  std::vector<FlogCell> moved_;         ///< used while the window moves
};

}  // namespace groundloop::slam
