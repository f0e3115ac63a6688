#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sim/world/world.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::sim {

struct RayHit {
  double distance_m = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  int geom = -1;  ///< MuJoCo geom id
};

/// The scene's exact geometry in a Bullet collision world, independent of the renderer. Holds every visible geom
/// of the world but the robot's own.
class TruthWorld {
 public:
  TruthWorld(const World& world, const mjData& data);
  ~TruthWorld();
  TruthWorld(const TruthWorld&) = delete;
  TruthWorld& operator=(const TruthWorld&) = delete;

  /// First surface along a ray; direction need not be of unit length.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                             double max_distance_m) const;

  /// Depth (z along the optical axis [m]) of the scene at a pixel of the left image; none beyond max_depth_m.
  std::optional<double> depth_m(const slam::StereoRig& rig, const slam::Pose& T_world_left, double u_px,
                                double v_px, double max_depth_m = 100) const;

  /// Exact occupancy: 1 where any geometry reaches into the cell between the two heights, else 0.
  slam::OccupancyMap occupancy(const slam::GridGeometry& geometry, double z_min_m, double z_max_m) const;

  /// A grid that covers all geometry but unbounded planes, with a margin of one cell.
  slam::GridGeometry bounds(double cell_m) const;

  /// Cells of `geometry` that the left camera saw from these poses, true where a pixel ray crosses the cell
  /// between the two heights before, or at, its first hit and not farther than max_range_m.
  std::vector<uint8_t> visible_cells(const slam::GridGeometry& geometry, const slam::StereoRig& rig,
                                     const std::vector<slam::Pose>& T_world_left, double z_min_m, double z_max_m,
                                     double max_range_m) const;

  /// Name of a geom touched by the robot's geoms moved to this body pose (planar footprint swept over the robot's
  /// height, enlarged by margin_m), or none.
  std::optional<std::string> collision(double x_m, double y_m, double yaw_rad, double margin_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
