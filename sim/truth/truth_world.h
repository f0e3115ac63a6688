#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
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

/// What the camera saw of a cell, as values of visible_cells().
enum CellSight : uint8_t {
  kUnseen = 0,
  kCrossed = 1,   ///< a ray went through it, or ended on a level face (a desk top, or its underside)
  kFaceSeen = 2,  ///< a ray ended on an upright face of geometry in it (steeper than 45 degrees)
};

/// Whether those who walk about belong to the scene: they are seen, but they are no part of what a map should
/// hold.
enum class People { kLeftOut, kSeen };

/// A geom seen from above: what a figure of the scene draws.
struct Outline {
  int geom = -1;                         ///< MuJoCo geom id
  std::string name;                      ///< geom name, or "geom 17 (body desk)"
  std::string body;                      ///< name of its body
  std::vector<Eigen::Vector2d> polygon;  ///< convex, counter-clockwise, world frame [m]
  double z_min_m = 0;
  double z_max_m = 0;
};

/// The scene's exact geometry in Bullet's collision structures, independent of the renderer. Holds every
/// visible geom of the world but the robot's own: truth is what can be seen, so geoms of group 3 and above
/// (which MuJoCo does not draw: collision-only) and geoms of alpha 0 are left out. Planes are the rectangles
/// that are drawn. Curved geoms are the exact quadrics; the renderer draws facets whose corners lie on them.
///
/// All members but move_to() are const and may be used by several threads.
class TruthWorld {
 public:
  /// @param world  must outlive this object
  /// @param data   state with positions computed (mj_forward or mj_kinematics); geoms are taken where they
  /// are now
  TruthWorld(const World& world, const mjData& data, People people = People::kLeftOut);
  /// The same of a bare model; robot_body is the root of the body tree to leave out, -1 for none.
  TruthWorld(const mjModel& model, const mjData& data, int robot_body);
  ~TruthWorld();
  TruthWorld(const TruthWorld&) = delete;
  TruthWorld& operator=(const TruthWorld&) = delete;

  /// Takes the geoms where they are now in another state of the same model.
  void move_to(const mjData& data);
  /// Where a geom is; none when it is not part of the scene.
  std::optional<slam::Pose> T_world_geom(int geom) const;

  /// First surface along a ray, from either side; direction need not be of unit length, max_distance_m is
  /// finite.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                             double max_distance_m) const;

  /// Depth (z along the optical axis [m]) of the scene at a pixel of the left image; none beyond max_depth_m.
  std::optional<double> depth_m(const slam::StereoRig& rig, const slam::Pose& T_world_left, double u_px,
                                double v_px, double max_depth_m = 100) const;

  /// Exact occupancy: 1 where any geometry reaches into the cell between the two heights, else 0. Geometry
  /// that only touches a cell (by less than 1e-6 m) does not occupy it. Box, sphere, ellipsoid, capsule and
  /// cylinder are full inside; meshes and height fields are their surfaces. The floor is kept out by z_min_m
  /// (about 0.02).
  slam::OccupancyMap occupancy(const slam::GridGeometry& geometry, double z_min_m, double z_max_m) const;

  /// A grid that covers all geometry but unbounded planes, with a margin of one cell; its borders are
  /// multiples of the cell size. Without bounded geometry it has no cells.
  slam::GridGeometry bounds(double cell_m) const;

  /// What the left camera saw of each cell of `geometry` from these poses, as CellSight: not 0 where a pixel
  /// ray crosses the cell between the two heights before, or at, its first hit and not farther than
  /// max_range_m along the ray. A face counts for the cell behind it, which holds the geometry. 128 x 40
  /// rays an image, spread evenly. What is behind people is not seen, and they themselves are no faces.
  std::vector<uint8_t> visible_cells(const slam::GridGeometry& geometry, const slam::StereoRig& rig,
                                     const std::vector<slam::Pose>& T_world_left, double z_min_m,
                                     double z_max_m, double max_range_m) const;

  /// Name of a geom touched by the robot's geoms moved to this body pose (planar footprint swept over the
  /// robot's height, enlarged by margin_m), or none. Each geom of the robot at qpos0 is swept from 2 cm above
  /// the floor (the height of the body origin at qpos0) to the robot's top; what lies above or below does not
  /// count.
  std::optional<std::string> collision(double x_m, double y_m, double yaw_rad, double margin_m) const;

  /// Radius of the circle about the origin of the robot's body that holds all of it at any heading; 0 without one.
  double robot_radius_m() const;

  /// Outlines of the bounded geoms that reach into the band between two heights, in the order of geom ids;
  /// curved ones as polygons of up to 64 corners.
  std::vector<Outline> footprints(double z_min_m, double z_max_m) const;

  /// "desk_top", or "geom 17 (body desk)" for a geom without a name.
  std::string geom_name(int geom) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
